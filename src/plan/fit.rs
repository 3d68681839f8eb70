//! Whether a plan fits an adapter.

use std::collections::BTreeMap;

use super::{DrawPlan, Phase, Plan};
use crate::error::{Error, Result};
use crate::gpu::buffers::Usage;
use crate::gpu::compose::GROUP_SIZE;
use crate::gpu::{Demand, Items, Limits, Shader, Variant};
use crate::render;
use crate::scene::Scene;

const ANOTHER: &str = "another adapter (`sliceflow devices` lists them)";

impl Plan {
    /// The plan with what each pass and each draw demands of an adapter, as its shader says.
    ///
    /// # Errors
    ///
    /// Where that is more than the limits allow.
    pub(super) fn demanding(mut self, scene: &Scene, limits: &Limits) -> Result<Self> {
        let of_step = self.variant_of(Phase::Step);
        let of_frame = self.variant_of(Phase::Observe);
        let mut shaders = Shaders::default();
        for row in &mut self.passes {
            let variant = match row.phase {
                Phase::Observe => &of_frame,
                Phase::Start | Phase::Step | Phase::Sample => &of_step,
            };
            row.demand = shaders.demand(&row.pass.shader, variant, &[&row.pass.entry])?;
        }
        if let Some(view) = self.wanted.view {
            let variant = render::variant(scene, view, &self.variant);
            for draw in &mut self.draws {
                draw.demand = shaders.demand(&draw.shader, &variant, &draw.entries())?;
            }
        }
        limits.check(self.demands())?;
        Ok(self)
    }

    /// Label and demand of every pass and draw.
    pub fn demands(&self) -> impl Iterator<Item = (&str, Demand)> + Clone {
        let passes = self
            .passes
            .iter()
            .map(|row| (row.pass.entry.as_str(), row.demand));
        passes.chain(self.draws.iter().map(|draw| (draw.label.as_str(), draw.demand)))
    }

    /// The pass or draw that binds the most storage buffers, and how many these are.
    pub fn most_storage_buffers(&self) -> (&str, u32) {
        self.demands()
            .map(|(label, demand)| (label, demand.storage_buffers))
            .max_by_key(|(_, count)| *count)
            .unwrap_or_default()
    }

    /// Refuses what is larger than the adapter allows, with the number that would fit.
    pub(super) fn check_sizes(&self, limits: &Limits) -> Result<()> {
        self.check_storage(limits)?;
        self.check_uniforms(limits)?;
        self.check_groups(limits)?;
        if let Some(texture) = self
            .textures
            .iter()
            .find(|t| t.size[0].max(t.size[1]) > limits.texture)
        {
            return Err(Error::Limit {
                what: format!(
                    "texture `{}` needs {}×{} pixels; this adapter has at most {} per side",
                    texture.name, texture.size[0], texture.size[1], limits.texture
                ),
                help: "choose a smaller --size or a lower render.antialias".into(),
            });
        }
        Ok(())
    }

    fn check_storage(&self, limits: &Limits) -> Result<()> {
        let most = limits.largest();
        let mut storage = self.buffers.iter().filter(|b| b.usage != Usage::Uniform);
        let Some(buffer) = storage.find(|b| b.bytes > most) else {
            return Ok(());
        };
        let fitting = |count: u32| u128::from(count) * u128::from(most) / u128::from(buffer.bytes);
        let name = buffer.name.as_str();
        let help = if PICTURE_BUFFERS.contains(&name) {
            format!("choose a smaller --size, or {ANOTHER}")
        } else if VOXEL_BUFFERS.contains(&name) {
            format!(
                "{} voxels would fit instead of {}: shrink the domain, enlarge the grains or the search radius, \
                 use fewer slots, choose a grid that takes less (--grid bitmap-counting) or {ANOTHER}",
                fitting(self.grid.capacity),
                self.grid.capacity
            )
        } else if DOMAIN_BUFFERS.contains(&name) {
            format!("shrink the domain, enlarge the grains or the search radius, or choose {ANOTHER}")
        } else if buffer.bytes >= 4 * u64::from(self.capacity) && !OTHER_BUFFERS.contains(&name) {
            format!(
                "{} particles would fit; or choose {ANOTHER}",
                fitting(self.capacity)
            )
        } else {
            format!("choose {ANOTHER}")
        };
        Err(Error::Limit {
            what: format!(
                "buffer `{name}` ({}) needs {} bytes; this adapter binds at most {most} at once",
                buffer.why, buffer.bytes
            ),
            help,
        })
    }

    fn check_uniforms(&self, limits: &Limits) -> Result<()> {
        // Of `pass_index`, each pass binds the four bytes of its own number.
        let mut uniform = self
            .buffers
            .iter()
            .filter(|b| b.usage == Usage::Uniform && b.name != "pass_index");
        match uniform.find(|buffer| buffer.bytes > limits.uniform) {
            None => Ok(()),
            Some(buffer) => Err(Error::Limit {
                what: format!(
                    "uniform buffer `{}` ({}) needs {} bytes; this adapter binds at most {} at once",
                    buffer.name, buffer.why, buffer.bytes, limits.uniform
                ),
                help: match TABLES.iter().find(|(name, _)| *name == buffer.name) {
                    Some((_, what)) => format!("have fewer {what}, or choose {ANOTHER}"),
                    None => format!("choose {ANOTHER}"),
                },
            }),
        }
    }

    /// Workgroups are folded into two dimensions.
    fn check_groups(&self, limits: &Limits) -> Result<()> {
        let most = u64::from(limits.groups) * u64::from(limits.groups);
        for row in &self.passes {
            let groups = match row.pass.items {
                Items::VoxelBlocks => self.scan_blocks(self.grid.capacity),
                items => self.most_items(items, self.capacity).div_ceil(GROUP_SIZE),
            };
            if u64::from(groups) > most {
                return Err(Error::Limit {
                    what: format!(
                        "pass `{}` needs {groups} workgroups; this adapter runs at most {most} at once",
                        row.pass.entry
                    ),
                    help: format!("take fewer particles or a smaller domain, or choose {ANOTHER}"),
                });
            }
        }
        Ok(())
    }
}

impl DrawPlan {
    /// Its entry points.
    fn entries(&self) -> Vec<&str> {
        std::iter::once(self.label.as_str())
            .chain(self.fragment.as_deref())
            .collect()
    }
}

/// Shaders that were composed already, and their variants.
#[derive(Default)]
struct Shaders(BTreeMap<String, Vec<(Variant, Shader)>>);

impl Shaders {
    fn demand(&mut self, path: &str, variant: &Variant, entries: &[&str]) -> Result<Demand> {
        let composed = self.0.entry(path.to_owned()).or_default();
        let place = match composed.iter().position(|(known, _)| known == variant) {
            Some(place) => place,
            None => {
                composed.push((variant.clone(), Shader::load(path, variant)?));
                composed.len() - 1
            }
        };
        composed[place].1.demand(entries)
    }
}

/// Buffers that grow with the number of voxels that have memory.
const VOXEL_BUFFERS: &[&str] = &[
    "voxel_start",
    "voxel_count",
    "index_pool",
    "block_sum",
    "row_bounds",
    "row_record",
    "voxel_mark",
    "voxel_word",
];

/// Uniform buffers that grow with what a scene has.
const TABLES: &[(&str, &str)] = &[
    ("colliders", "obstacles"),
    ("body_velocity", "obstacles"),
    ("materials", "materials"),
];

/// Buffers that grow with the domain's sides.
const DOMAIN_BUFFERS: &[&str] = &[
    "slice_bounds",
    "slice_record",
    "slice_rows",
    "column_mark",
    "column_region",
];

/// Buffers that may be large whatever the number of particles.
const OTHER_BUFFERS: &[&str] = &["distance_field", "voxel_map", "collider_vertex"];

/// Buffers that grow with the picture.
const PICTURE_BUFFERS: &[&str] = &[
    "frame_pixels",
    "block_depth",
    "blur_sum",
    "pass_color",
    "pass_depth",
    "pass_normal",
    "pass_id",
    "pass_velocity",
    "pass_motion",
];
