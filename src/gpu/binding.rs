//! Layouts and bind groups: what entry points use, bound by name.

use crate::error::Result;
use crate::gpu::reflect::{Resource, ResourceKind, Texels};
use crate::gpu::{Buffers, Gpu, Shader};

/// A resource that is no whole buffer (a texture, a sampler, an element of a buffer), and its name.
pub type Given<'a> = (&'a str, wgpu::BindingResource<'a>);

/// The resources of entry points that share one pipeline.
#[derive(Clone)]
pub struct Bindings {
    /// What the pass or draw is called, and its shader's file.
    label: String,
    path: String,
    resources: Vec<Resource>,
    layout: wgpu::BindGroupLayout,
}

impl Bindings {
    /// Each resource is visible to the stages that use it. The first of `entries` gives the whole its name.
    ///
    /// # Errors
    ///
    /// Where the adapter allows less than they take.
    pub fn new(gpu: &Gpu, shader: &Shader, entries: &[&str]) -> Result<Self> {
        let label = entries.first().copied().unwrap_or_default();
        gpu.limits
            .check(std::iter::once((label, shader.demand(entries)?)))?;
        let mut used: Vec<(Resource, wgpu::ShaderStages)> = Vec::new();
        for entry in entries {
            let stage = visibility(shader.stage(entry)?);
            for resource in shader.resources(entry)? {
                match used.iter_mut().find(|(known, _)| *known == resource) {
                    Some((_, stages)) => *stages |= stage,
                    None => used.push((resource, stage)),
                }
            }
        }
        let layout: Vec<_> = used
            .iter()
            .map(|(resource, stages)| wgpu::BindGroupLayoutEntry {
                binding: resource.binding,
                visibility: *stages,
                ty: resource.kind.layout(),
                count: None,
            })
            .collect();
        let layout = gpu.make(
            || format!("the bindings of `{label}`"),
            |device| {
                device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                    label: Some(label),
                    entries: &layout,
                })
            },
        )?;
        Ok(Self {
            label: label.to_owned(),
            path: shader.path.clone(),
            resources: used.into_iter().map(|(resource, _)| resource).collect(),
            layout,
        })
    }

    /// Names of all that is bound.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.resources.iter().map(|resource| resource.name.as_str())
    }

    pub fn pipeline_layout(&self, device: &wgpu::Device) -> wgpu::PipelineLayout {
        device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(&self.label),
            bind_group_layouts: &[Some(&self.layout)],
            immediate_size: 0,
        })
    }

    /// Binds each resource by its name, first from `given`, then from `buffers`.
    pub fn bind(&self, gpu: &Gpu, buffers: &Buffers, given: &[Given<'_>]) -> Result<wgpu::BindGroup> {
        let mut bound = Vec::new();
        for resource in &self.resources {
            let what = match given.iter().find(|(name, _)| *name == resource.name) {
                Some((_, given)) => given.clone(),
                None => buffers.get(&resource.name, &self.path)?.as_entire_binding(),
            };
            bound.push(wgpu::BindGroupEntry {
                binding: resource.binding,
                resource: what,
            });
        }
        gpu.make(
            || format!("the bindings of `{}`", self.label),
            |device| {
                device.create_bind_group(&wgpu::BindGroupDescriptor {
                    label: Some(&self.label),
                    layout: &self.layout,
                    entries: &bound,
                })
            },
        )
    }
}

fn visibility(stage: naga::ShaderStage) -> wgpu::ShaderStages {
    match stage {
        naga::ShaderStage::Vertex => wgpu::ShaderStages::VERTEX,
        naga::ShaderStage::Fragment => wgpu::ShaderStages::FRAGMENT,
        _ => wgpu::ShaderStages::COMPUTE,
    }
}

impl ResourceKind {
    fn layout(self) -> wgpu::BindingType {
        let buffer = |ty| wgpu::BindingType::Buffer {
            ty,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        match self {
            Self::Uniform => buffer(wgpu::BufferBindingType::Uniform),
            Self::Storage { read_only } => buffer(wgpu::BufferBindingType::Storage { read_only }),
            Self::Texture(texels) => wgpu::BindingType::Texture {
                sample_type: match texels {
                    Texels::Depth => wgpu::TextureSampleType::Depth,
                    Texels::Color => wgpu::TextureSampleType::Float { filterable: true },
                    Texels::Unsigned => wgpu::TextureSampleType::Uint,
                },
                view_dimension: wgpu::TextureViewDimension::D2,
                multisampled: false,
            },
            Self::Sampler { comparison } => wgpu::BindingType::Sampler(if comparison {
                wgpu::SamplerBindingType::Comparison
            } else {
                wgpu::SamplerBindingType::Filtering
            }),
        }
    }
}
