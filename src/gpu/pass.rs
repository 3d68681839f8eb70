//! A compute pass: an entry point of a shader, its buffers bound by name.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use crate::error::Result;
use crate::gpu::binding::{Bindings, Given};
use crate::gpu::compose::compose;
use crate::gpu::{Buffers, Gpu, Shader, Variant};

/// Bytes from one element of `pass_index` to the next; a multiple of every adapter's alignment of uniforms.
pub const INDEX_STRIDE: u64 = 256;

/// A compiled entry point: what all passes that run it share.
#[derive(Clone)]
pub struct Kernel {
    label: String,
    pipeline: wgpu::ComputePipeline,
    bindings: Bindings,
    threads: u32,
}

/// What a device has compiled, by the text of the shader and the name of the entry point; clones share it.
#[derive(Clone, Default)]
pub(super) struct Kernels(Arc<Mutex<HashMap<(String, String), Kernel>>>);

#[cfg(all(test, feature = "surface"))]
impl Gpu {
    /// How many entry points the device has compiled.
    pub(crate) fn compiled(&self) -> usize {
        self.kernels
            .0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .len()
    }
}

impl Kernel {
    /// An entry point of `shaders/{path}.wgsl`. A device compiles each composed text once, for all who ask for it.
    ///
    /// # Errors
    ///
    /// A mistake in the shader, and what the adapter does not allow or the device refuses.
    pub fn load(gpu: &Gpu, path: &str, variant: &Variant, entry: &str) -> Result<Self> {
        let composed = compose(path, variant)?;
        let key = (composed.text.clone(), entry.to_owned());
        let kernels = || gpu.kernels.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(kernel) = kernels().get(&key) {
            return Ok(kernel.clone());
        }
        let kernel = Self::new(gpu, &Shader::from_composed(&composed)?, entry)?;
        kernels().insert(key, kernel.clone());
        Ok(kernel)
    }

    fn new(gpu: &Gpu, shader: &Shader, entry: &str) -> Result<Self> {
        let bindings = Bindings::new(gpu, shader, &[entry])?;
        let module = shader.module(gpu)?;
        let pipeline = gpu.make(
            || format!("pass `{entry}`"),
            |device| {
                device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                    label: Some(entry),
                    layout: Some(&bindings.pipeline_layout(device)),
                    module: &module,
                    entry_point: Some(entry),
                    compilation_options: wgpu::PipelineCompilationOptions {
                        zero_initialize_workgroup_memory: gpu.checked_shaders,
                        ..Default::default()
                    },
                    cache: None,
                })
            },
        )?;
        Ok(Self {
            label: entry.to_owned(),
            pipeline,
            bindings,
            threads: shader.workgroup_threads(entry)?,
        })
    }

    /// A pass over this entry point that finds everything in `buffers`.
    pub fn pass(&self, gpu: &Gpu, buffers: &Buffers) -> Result<Pass> {
        self.pass_with(gpu, buffers, &[])
    }

    /// A pass in which each `name` and `next_name` that both are there have changed places.
    pub fn flipped_pass(&self, gpu: &Gpu, buffers: &Buffers) -> Result<Pass> {
        let mut given = Vec::new();
        for name in self.bindings.names() {
            let other = match name.strip_prefix("next_") {
                Some(now) => now.to_owned(),
                None => format!("next_{name}"),
            };
            if buffers.contains(&other) {
                given.push((name, buffers.get(&other, &self.label)?.as_entire_binding()));
            }
        }
        self.pass_with(gpu, buffers, &given)
    }

    /// A pass whose `pass_index` is the element at `place` of the buffer of that name.
    pub fn numbered_pass(&self, gpu: &Gpu, buffers: &Buffers, place: usize) -> Result<Pass> {
        let element = wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer: buffers.get("pass_index", &self.label)?,
            offset: place as u64 * INDEX_STRIDE,
            size: wgpu::BufferSize::new(4),
        });
        self.pass_with(gpu, buffers, &[("pass_index", element)])
    }

    /// A pass that binds what is in `given`, and all else from `buffers`.
    pub fn pass_with(&self, gpu: &Gpu, buffers: &Buffers, given: &[Given<'_>]) -> Result<Pass> {
        Ok(Pass {
            label: self.label.clone(),
            pipeline: self.pipeline.clone(),
            bind_group: self.bindings.bind(gpu, buffers, given)?,
            threads: self.threads,
            max_groups: gpu.limits.groups,
        })
    }
}

pub struct Pass {
    pub label: String,
    pipeline: wgpu::ComputePipeline,
    bind_group: wgpu::BindGroup,
    threads: u32,
    /// Workgroups that fit in one dimension of a dispatch.
    max_groups: u32,
}

impl Pass {
    /// Runs at least `items` threads. More groups than one dimension holds are folded into a second one, which
    /// `thread_index` of `common/thread.wgsl` unfolds.
    pub fn encode(&self, pass: &mut wgpu::ComputePass<'_>, items: u32) {
        self.dispatch(pass, Groups::For(items));
    }

    pub fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>, groups: Groups<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.bind_group, &[]);
        match groups {
            Groups::For(items) => {
                let (x, y) = fold(items.div_ceil(self.threads), self.max_groups);
                pass.dispatch_workgroups(x, y, 1);
            }
            Groups::From(buffer, offset) => pass.dispatch_workgroups_indirect(buffer, offset),
        }
    }
}

/// How many workgroups a dispatch has.
#[derive(Clone, Copy)]
pub enum Groups<'a> {
    /// As many as so many threads need.
    For(u32),
    /// What stands at this offset of a buffer, in bytes: x, y, z.
    From(&'a wgpu::Buffer, u64),
}

/// Splits `groups` workgroups into two dimensions of at most `most` each, the first as wide as possible.
pub fn fold(groups: u32, most: u32) -> (u32, u32) {
    if groups <= most {
        (groups, 1)
    } else {
        (most, groups.div_ceil(most))
    }
}

#[cfg(test)]
mod tests {
    use super::fold;

    #[test]
    fn folding_covers_every_group() {
        for groups in [1, 4, 5, 16, 17, 65_535, 65_536, 1_000_000] {
            for most in [4, 65_535] {
                let (x, y) = fold(groups, most);
                assert!(x <= most && x * y >= groups && x * (y - 1) < groups);
            }
        }
    }
}
