//! A compute pass: an entry point of a shader, its buffers bound by name.

use crate::error::Result;
use crate::gpu::{Buffers, Gpu, Shader};

pub struct Pass {
    pub label: String,
    pipeline: wgpu::ComputePipeline,
    bind_group: wgpu::BindGroup,
    threads: u32,
    /// Workgroups that fit in one dimension of a dispatch.
    max_groups: u32,
}

impl Pass {
    pub fn new(gpu: &Gpu, shader: &Shader, entry: &str, buffers: &Buffers) -> Result<Self> {
        Self::with_textures(gpu, shader, entry, buffers, &[])
    }

    /// A pass that also reads textures, given by name.
    pub fn with_textures(
        gpu: &Gpu,
        shader: &Shader,
        entry: &str,
        buffers: &Buffers,
        textures: &[(&str, wgpu::BindingResource<'_>)],
    ) -> Result<Self> {
        let (layout, bind_group) =
            shader.bind(gpu, &[entry], wgpu::ShaderStages::COMPUTE, buffers, textures)?;
        let module = shader.module(gpu);
        let pipeline = gpu
            .device
            .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry),
                layout: Some(&layout),
                module: &module,
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions {
                    zero_initialize_workgroup_memory: gpu.checked_shaders,
                    ..Default::default()
                },
                cache: None,
            });
        Ok(Self {
            label: entry.to_owned(),
            pipeline,
            bind_group,
            threads: shader.workgroup_threads(entry)?,
            max_groups: gpu.limits.groups,
        })
    }

    /// Runs at least `items` threads. More groups than one dimension holds are folded into a second one, which
    /// `thread_index` of `common/thread.wgsl` unfolds.
    pub fn encode(&self, pass: &mut wgpu::ComputePass<'_>, items: u32) {
        let (x, y) = fold(items.div_ceil(self.threads), self.max_groups);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.bind_group, &[]);
        pass.dispatch_workgroups(x, y, 1);
    }
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
