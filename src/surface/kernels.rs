//! Compiled passes of surfaces, which serve one frame after the other.

use std::collections::BTreeMap;

use crate::error::Result;
use crate::gpu::binding::Given;
use crate::gpu::compose::compose;
use crate::gpu::{Buffers, Gpu, Kernel, Pass, Shader, Variant};

/// By the text of their shader and their name.
#[derive(Default)]
pub struct Kernels {
    made: BTreeMap<(String, String), Kernel>,
}

impl Kernels {
    /// A pass that binds what is in `given`, and all else from `buffers`.
    pub fn pass(
        &mut self,
        gpu: &Gpu,
        variant: &Variant,
        [shader, entry]: [&str; 2],
        buffers: &Buffers,
        given: &[Given<'_>],
    ) -> Result<Pass> {
        let composed = compose(shader, variant)?;
        let key = (composed.text.clone(), entry.to_owned());
        if !self.made.contains_key(&key) {
            let shader = Shader::from_composed(&composed)?;
            self.made.insert(key.clone(), Kernel::new(gpu, &shader, entry)?);
        }
        self.made[&key].pass_with(gpu, buffers, given)
    }
}
