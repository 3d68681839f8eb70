//! A parsed, validated shader module and what it tells about itself: bindings by name, workgroup sizes, structs.

use std::collections::BTreeSet;

use naga::proc::Layouter;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{AddressSpace, Binding, ResourceBinding, StorageAccess, TypeInner};

use super::compose::{self, Composed, Variant};
use super::limits::Demand;
use crate::error::{Error, Result};

/// A composed module, parsed and validated without a GPU.
pub struct Shader {
    pub path: String,
    pub module: naga::Module,
    pub(super) info: ModuleInfo,
}

/// One resource that an entry point uses.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Resource {
    pub name: String,
    pub binding: u32,
    pub kind: ResourceKind,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ResourceKind {
    Uniform,
    Storage { read_only: bool },
    Texture(Texels),
    Sampler { comparison: bool },
}

/// What a texture holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Texels {
    Depth,
    /// Numbers that may be filtered.
    Color,
    Unsigned,
}

/// A struct of a shader, field by field.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StructLayout {
    pub name: String,
    pub size: u32,
    /// Name, offset, size in bytes.
    pub fields: Vec<(String, u32, u32)>,
}

impl Shader {
    /// Composes and validates `shaders/{path}.wgsl`; the message of an error names the author's file and line.
    pub fn load(path: &str, variant: &Variant) -> Result<Self> {
        Self::from_composed(&compose::compose(path, variant)?)
    }

    pub fn from_composed(composed: &Composed) -> Result<Self> {
        let fail = |line: Option<usize>, message: String| {
            let place = line.map_or_else(|| format!("shaders/{}", composed.path), |l| composed.place(l));
            let text = line.and_then(|l| composed.text.lines().nth(l - 1)).unwrap_or("");
            Error::Shader {
                message: format!("{place}: {message}\n    {}", text.trim()),
            }
        };
        let mut module = naga::front::wgsl::parse_str(&composed.text).map_err(|error| {
            let line = error.location(&composed.text).map(|l| l.line_number as usize);
            fail(line, error.message().to_owned())
        })?;
        // The author writes no binding numbers; the order of declaration gives them.
        for (number, (_, global)) in module.global_variables.iter_mut().enumerate() {
            if matches!(
                global.space,
                AddressSpace::Uniform | AddressSpace::Storage { .. } | AddressSpace::Handle
            ) {
                global.binding = Some(ResourceBinding {
                    group: 0,
                    binding: number as u32,
                });
            }
        }
        let info = Validator::new(ValidationFlags::all(), Capabilities::all())
            .validate(&module)
            .map_err(|error| {
                let line = error.location(&composed.text).map(|l| l.line_number as usize);
                let mut message = error.as_inner().to_string();
                let mut cause: Option<&dyn std::error::Error> = std::error::Error::source(error.as_inner());
                while let Some(inner) = cause {
                    message = format!("{message}: {inner}");
                    cause = inner.source();
                }
                fail(line, message)
            })?;
        Ok(Self {
            path: composed.path.clone(),
            module,
            info,
        })
    }

    pub(super) fn entry_index(&self, entry: &str) -> Result<usize> {
        let found = self.module.entry_points.iter().position(|e| e.name == entry);
        found.ok_or_else(|| Error::Shader {
            message: format!("shaders/{} has no entry point `{entry}`", self.path),
        })
    }

    /// Names of the module's entry points.
    pub fn entries(&self) -> impl Iterator<Item = &str> {
        self.module.entry_points.iter().map(|e| e.name.as_str())
    }

    /// The stage of an entry point.
    pub fn stage(&self, entry: &str) -> Result<naga::ShaderStage> {
        Ok(self.module.entry_points[self.entry_index(entry)?].stage)
    }

    /// What entry points that share one pipeline take of an adapter's limits.
    pub fn demand(&self, entries: &[&str]) -> Result<Demand> {
        let mut demand = Demand::default();
        let mut bound = BTreeSet::new();
        for entry in entries {
            let resources = self.resources(entry)?;
            let count = |of: fn(ResourceKind) -> bool| resources.iter().filter(|r| of(r.kind)).count() as u32;
            let of_stage = Demand {
                storage_buffers: count(|kind| matches!(kind, ResourceKind::Storage { .. })),
                uniform_buffers: count(|kind| kind == ResourceKind::Uniform),
                textures: count(|kind| matches!(kind, ResourceKind::Texture(_))),
                samplers: count(|kind| matches!(kind, ResourceKind::Sampler { .. })),
                threads: match self.stage(entry)? {
                    naga::ShaderStage::Compute => self.workgroup_threads(entry)?,
                    _ => 0,
                },
                group_bytes: self.workgroup_bytes(entry)?,
                bindings: 0,
            };
            bound.extend(resources.iter().map(|resource| resource.binding));
            demand = demand.or_more(&of_stage);
        }
        demand.bindings = bound.len() as u32;
        Ok(demand)
    }

    /// Bytes that the threads of one workgroup share.
    fn workgroup_bytes(&self, entry: &str) -> Result<u32> {
        let used = self.info.get_entry_point(self.entry_index(entry)?);
        let mut layouter = Layouter::default();
        layouter
            .update(self.module.to_ctx())
            .map_err(|error| Error::Shader {
                message: format!("shaders/{}: {error}", self.path),
            })?;
        let shared = self.module.global_variables.iter();
        Ok(shared
            .filter(|(handle, global)| global.space == AddressSpace::WorkGroup && !used[*handle].is_empty())
            .map(|(_, global)| layouter[global.ty].to_stride())
            .sum())
    }

    /// Threads of one workgroup of a compute entry point.
    pub fn workgroup_threads(&self, entry: &str) -> Result<u32> {
        let size = self.module.entry_points[self.entry_index(entry)?].workgroup_size;
        Ok(size.iter().product())
    }

    /// What an entry point reads or writes, and nothing else.
    pub fn resources(&self, entry: &str) -> Result<Vec<Resource>> {
        let used = self.info.get_entry_point(self.entry_index(entry)?);
        let mut found = Vec::new();
        for (handle, global) in self.module.global_variables.iter() {
            let Some(place) = &global.binding else { continue };
            if used[handle].is_empty() {
                continue;
            }
            let kind = match global.space {
                AddressSpace::Uniform => ResourceKind::Uniform,
                AddressSpace::Storage { access } => ResourceKind::Storage {
                    read_only: !access.contains(StorageAccess::STORE),
                },
                _ => match self.module.types[global.ty].inner {
                    TypeInner::Image { class, .. } => ResourceKind::Texture(match class {
                        naga::ImageClass::Depth { .. } => Texels::Depth,
                        naga::ImageClass::Sampled {
                            kind: naga::ScalarKind::Uint,
                            ..
                        } => Texels::Unsigned,
                        _ => Texels::Color,
                    }),
                    TypeInner::Sampler { comparison } => ResourceKind::Sampler { comparison },
                    _ => continue,
                },
            };
            found.push(Resource {
                name: global.name.clone().unwrap_or_default(),
                binding: place.binding,
                kind,
            });
        }
        Ok(found)
    }

    /// Every named struct of the module.
    pub fn structs(&self) -> Vec<StructLayout> {
        let mut layouter = Layouter::default();
        if layouter.update(self.module.to_ctx()).is_err() {
            return Vec::new();
        }
        let mut found = Vec::new();
        for (_, ty) in self.module.types.iter() {
            let (Some(name), TypeInner::Struct { members, span }) = (&ty.name, &ty.inner) else {
                continue;
            };
            let built_in = |m: &naga::StructMember| {
                matches!(m.binding, Some(Binding::BuiltIn(_) | Binding::Location { .. }))
            };
            if members.iter().any(built_in) {
                continue;
            }
            found.push(StructLayout {
                name: name.clone(),
                size: *span,
                fields: members
                    .iter()
                    .map(|m| (m.name.clone().unwrap_or_default(), m.offset, layouter[m.ty].size))
                    .collect(),
            });
        }
        found
    }

    /// Hands the module to the device.
    ///
    /// # Errors
    ///
    /// Where the device or the driver refuses it.
    pub fn module(&self, gpu: &super::Gpu) -> Result<wgpu::ShaderModule> {
        let descriptor = wgpu::ShaderModuleDescriptor {
            label: Some(&self.path),
            source: wgpu::ShaderSource::Naga(std::borrow::Cow::Owned(self.module.clone())),
        };
        let checks = if gpu.checked_shaders {
            wgpu::ShaderRuntimeChecks::checked()
        } else {
            wgpu::ShaderRuntimeChecks::unchecked()
        };
        gpu.make(
            || format!("shaders/{}", self.path),
            // SAFETY: the modules are our own; the tests run each of them with all checks on.
            |device| unsafe { device.create_shader_module_trusted(descriptor, checks) },
        )
    }
}
