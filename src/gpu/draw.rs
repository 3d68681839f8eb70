//! A draw: a vertex and a fragment entry point of a shader, its resources bound by name.
//!
//! There are no vertex buffers: the vertex stage pulls what it needs from storage buffers.

use crate::error::Result;
use crate::gpu::binding::{Bindings, Given};
use crate::gpu::{Buffers, Gpu, Shader};

/// Depth is kept as 32-bit floats.
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// How fragments enter the color target.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Blend {
    /// They take the place of what was there, and their depth is written.
    Opaque,
    /// They are laid over; colors stand multiplied by their alpha, depth is tested and not written.
    Over,
    /// They are added to what was there; depth is neither tested nor kept.
    Add,
}

const SUM: wgpu::BlendState = wgpu::BlendState {
    color: ADDED,
    alpha: ADDED,
};
const ADDED: wgpu::BlendComponent = wgpu::BlendComponent {
    src_factor: wgpu::BlendFactor::One,
    dst_factor: wgpu::BlendFactor::One,
    operation: wgpu::BlendOperation::Add,
};

/// What a draw is drawn into and how.
#[derive(Debug, Clone, Copy)]
pub struct DrawStyle {
    /// `None` for draws that write depth only.
    pub color: Option<(wgpu::TextureFormat, Blend)>,
    pub topology: wgpu::PrimitiveTopology,
}

pub struct Draw {
    pub label: String,
    pipeline: wgpu::RenderPipeline,
    bindings: Bindings,
    bind_group: wgpu::BindGroup,
}

impl Draw {
    /// `fragment` may be left out where depth is all that is wanted.
    pub fn new(
        gpu: &Gpu,
        shader: &Shader,
        vertex: &str,
        fragment: Option<&str>,
        style: DrawStyle,
        buffers: &Buffers,
        given: &[Given<'_>],
    ) -> Result<Self> {
        let entries: Vec<&str> = std::iter::once(vertex).chain(fragment).collect();
        let bindings = Bindings::new(gpu, shader, &entries)?;
        let module = shader.module(gpu)?;
        let blend = style.color.map_or(Blend::Opaque, |(_, blend)| blend);
        let target = style.color.map(|(format, blend)| wgpu::ColorTargetState {
            format,
            blend: match blend {
                Blend::Opaque => None,
                Blend::Over => Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                Blend::Add => Some(SUM),
            },
            write_mask: wgpu::ColorWrites::ALL,
        });
        let targets: &[Option<wgpu::ColorTargetState>] = match &target {
            Some(target) => &[Some(target.clone())],
            None => &[],
        };
        let make = |device: &wgpu::Device| {
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(vertex),
                layout: Some(&bindings.pipeline_layout(device)),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some(vertex),
                    compilation_options: Default::default(),
                    buffers: &[],
                },
                primitive: wgpu::PrimitiveState {
                    topology: style.topology,
                    ..Default::default()
                },
                depth_stencil: (blend != Blend::Add).then(|| wgpu::DepthStencilState {
                    format: DEPTH_FORMAT,
                    depth_write_enabled: Some(blend == Blend::Opaque),
                    // Of two fragments at one depth the first drawn stays: buffer order, which is repeatable.
                    depth_compare: Some(wgpu::CompareFunction::Less),
                    stencil: Default::default(),
                    bias: Default::default(),
                }),
                multisample: Default::default(),
                fragment: fragment.map(|entry| wgpu::FragmentState {
                    module: &module,
                    entry_point: Some(entry),
                    compilation_options: Default::default(),
                    targets,
                }),
                multiview_mask: None,
                cache: None,
            })
        };
        let pipeline = gpu.make(|| format!("draw `{vertex}`"), make)?;
        Ok(Self {
            label: vertex.to_owned(),
            pipeline,
            bind_group: bindings.bind(gpu, buffers, given)?,
            bindings,
        })
    }

    /// Binds other resources from now on.
    pub fn rebind(&mut self, gpu: &Gpu, buffers: &Buffers, given: &[Given<'_>]) -> Result<()> {
        self.bind_group = self.bindings.bind(gpu, buffers, given)?;
        Ok(())
    }

    /// Draws `vertices` for each of `instances`.
    pub fn encode(&self, pass: &mut wgpu::RenderPass<'_>, vertices: u32, instances: u32) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.bind_group, &[]);
        pass.draw(0..vertices, 0..instances);
    }
}
