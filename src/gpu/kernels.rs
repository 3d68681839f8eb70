//! Compiled entry points, which outlive the buffers that their passes bind.

use std::collections::BTreeMap;

use crate::error::Result;
use crate::gpu::compose::compose;
use crate::gpu::{Gpu, Kernel, Shader, Variant};

/// By the text of their shader and their name: one file may be composed in several ways.
#[derive(Default)]
pub struct Kernels {
    compiled: BTreeMap<(String, String), Kernel>,
}

impl Kernels {
    /// The entry point of a shader file, compiled where none before was the same.
    pub fn get(&mut self, gpu: &Gpu, variant: &Variant, file: &str, entry: &str) -> Result<&Kernel> {
        let composed = compose(file, variant)?;
        let key = (composed.text.clone(), entry.to_owned());
        if !self.compiled.contains_key(&key) {
            let shader = Shader::from_composed(&composed)?;
            self.compiled
                .insert(key.clone(), Kernel::new(gpu, &shader, entry)?);
        }
        Ok(&self.compiled[&key])
    }

    /// How many have been compiled.
    pub fn compiled(&self) -> usize {
        self.compiled.len()
    }
}
