//! Layouts and bind groups: what entry points use, bound by name.

use crate::error::Result;
use crate::gpu::reflect::{Resource, ResourceKind};
use crate::gpu::{Buffers, Gpu, Shader};

/// A resource that is no whole buffer (a texture, a sampler, an element of a buffer), and its name.
pub type Given<'a> = (&'a str, wgpu::BindingResource<'a>);

/// The resources of entry points that share one pipeline.
#[derive(Clone)]
pub struct Bindings {
    path: String,
    resources: Vec<Resource>,
    layout: wgpu::BindGroupLayout,
}

impl Bindings {
    /// `visibility` is who sees the resources.
    pub fn new(gpu: &Gpu, shader: &Shader, entries: &[&str], visibility: wgpu::ShaderStages) -> Result<Self> {
        let mut resources: Vec<Resource> = Vec::new();
        for entry in entries {
            for resource in shader.resources(entry)? {
                if !resources.contains(&resource) {
                    resources.push(resource);
                }
            }
        }
        let entries: Vec<_> = resources
            .iter()
            .map(|resource| wgpu::BindGroupLayoutEntry {
                binding: resource.binding,
                visibility,
                ty: resource.kind.layout(),
                count: None,
            })
            .collect();
        let layout = gpu
            .device
            .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some(&shader.path),
                entries: &entries,
            });
        Ok(Self {
            path: shader.path.clone(),
            resources,
            layout,
        })
    }

    /// Names of all that is bound.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.resources.iter().map(|resource| resource.name.as_str())
    }

    pub fn pipeline_layout(&self, gpu: &Gpu) -> wgpu::PipelineLayout {
        gpu.device
            .create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(&self.path),
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
        Ok(gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(&self.path),
            layout: &self.layout,
            entries: &bound,
        }))
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
            Self::Texture { depth } => wgpu::BindingType::Texture {
                sample_type: if depth {
                    wgpu::TextureSampleType::Depth
                } else {
                    wgpu::TextureSampleType::Float { filterable: true }
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
