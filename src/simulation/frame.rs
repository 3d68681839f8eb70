//! A finished frame: what a simulation hands to the sinks.

use std::collections::BTreeMap;

use glam::DVec3;

use super::sensors::Sample;
use crate::neighbors::boxes::{VoxelBox, boxes};
use crate::neighbors::{Grid, NO_VOXEL};
use crate::physics::Model;
use crate::physics::bodies::BodyMotion;
use crate::physics::layout::{Convergence, Occupancy, Overflow, Packed, Sums};
use crate::plan::Plan;
use crate::scene::Scene;
use crate::scene::column::Column;
use crate::scene::field::Kind;
use crate::scene::model::ImagePass;

/// One moment of a run, on the host.
#[derive(Debug, Clone, Default)]
pub struct Frame {
    pub index: u32,
    /// Seconds of simulated time.
    pub time: f64,
    /// Steps since the run began.
    pub steps: u64,
    /// Length of the steps since the last frame, or their mean, seconds.
    pub step_s: f64,
    /// What limited most of them.
    pub step_limited_by: &'static str,
    /// Where the device chose their lengths.
    pub adaptive: Option<AdaptiveSteps>,
    /// Boundary particles apart.
    pub particles: u32,
    pub boundary_particles: u32,
    /// How often a particle found its voxel of a pool full, summed over all searches since the last frame.
    pub overflow: u64,
    /// How the loops of an iterative pressure solver went since the last frame.
    pub convergence: Option<Convergence>,
    /// Particles farther away than the search follows; they find no neighbors.
    pub quarantined: u32,
    /// Steps since the last frame that searched neighbors anew; in the others earlier lists served.
    pub searches: u32,
    /// How often the grid's buffers were made larger since the last frame.
    pub reallocations: u32,
    /// Why neighbor lists, which the scene asks for, have been left out.
    pub lists_left_out: Option<String>,
    /// RGBA, 8 bits each, sRGB, rows from the top without padding.
    pub pixels: Option<Vec<u8>>,
    /// Extra images, as the device wrote them: see [`crate::render::passes`].
    pub passes: Vec<(ImagePass, Vec<u8>)>,
    pub statistics: Option<Statistics>,
    /// What sensors found since the last frame, by time.
    pub samples: Vec<Sample>,
    /// Rigid bodies, in the order of the scene.
    pub bodies: Vec<BodyMotion>,
    /// In order of id.
    pub columns: Vec<ColumnData>,
    pub voxels: Option<Voxels>,
    /// Label and milliseconds of the passes of one step and of the frame's own passes, where they were timed.
    pub pass_ms: Vec<(String, f64)>,
}

/// Steps since the last frame, each of a length of its own.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct AdaptiveSteps {
    /// Seconds.
    pub shortest_s: f64,
    pub longest_s: f64,
    /// How many steps each term limited, the terms that limited none left out.
    pub limited_by: Vec<(&'static str, u32)>,
}

/// Where the search has voxels in memory, and how full they are.
#[derive(Debug, Clone, PartialEq)]
pub struct Voxels {
    pub boxes: Vec<VoxelBox>,
    /// Particles per voxel in the order of memory, folded into a square; rows from the top, the fullest of a block where
    /// there are more voxels than texels. `None` where there is no voxel.
    pub map: Vec<Option<u32>>,
}

/// Figures over all particles and voxels.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Statistics {
    /// Joules.
    pub kinetic_energy: f64,
    /// Joules, zero at the domain's lower corner.
    pub potential_energy: f64,
    /// m/s.
    pub max_speed: f64,
    /// The deepest contact, as a share of the radius.
    pub max_overlap: f64,
    /// Contacts as each grain sees them; one of two grains counts twice.
    pub contacts: u64,
    /// Of a fluid, the mean and the greatest |ρ/ρ₀ − 1| over its particles.
    pub density_error: Option<[f64; 2]>,
    /// Of a fluid whose negative pressures are clamped: particles whose pressure counts as zero therefore, and those of
    /// them whose density is the lowest allowed.
    pub clamped: Option<[u32; 2]>,
    pub voxels_allocated: u32,
    pub voxels_occupied: u32,
    /// Voxels with one, two, three, four particles.
    pub voxels_with: [u32; 4],
    pub voxels_with_more: u32,
    /// Particles that found no slot in the search for this frame.
    pub overflow: u32,
}

impl AdaptiveSteps {
    /// Seconds, with so many frames per second.
    pub(super) fn mean_s(&self, fps: f64) -> f64 {
        let steps: u32 = self.limited_by.iter().map(|(_, steps)| steps).sum();
        1.0 / (fps * f64::from(steps))
    }

    /// What limited most of them.
    pub(super) fn usual_limit(&self) -> &'static str {
        let most = self.limited_by.iter().max_by_key(|(_, steps)| *steps);
        most.map_or("", |(name, _)| name)
    }
}

impl Statistics {
    pub(super) fn new(
        scene: &Scene,
        model: &Model,
        particles: u32,
        sums: Sums,
        occupancy: Occupancy,
        overflow: Overflow,
    ) -> Self {
        let own = (model.sums)(scene, particles, &sums);
        let [_, one, two, three, four, more] = occupancy.holding;
        Self {
            kinetic_energy: f64::from(sums.kinetic_energy),
            potential_energy: f64::from(sums.potential_energy),
            max_speed: f64::from(sums.max_speed),
            max_overlap: f64::from(sums.max_overlap) / scene.radius(),
            contacts: u64::from(sums.contacts),
            density_error: own.density_error,
            clamped: own.clamped,
            voxels_allocated: occupancy.voxels,
            voxels_occupied: one + two + three + four + more,
            voxels_with: [one, two, three, four],
            voxels_with_more: more,
            overflow: overflow.now,
        }
    }
}

impl Voxels {
    /// Of the bytes of `voxel_map` and of the addressing's record.
    pub(super) fn new(scene: &Scene, grid: &Grid, map: &[u8], record: &[u8]) -> Self {
        let counts: Vec<u32> = bytemuck::pod_collect_to_vec(map);
        Self {
            boxes: boxes(scene, grid, record),
            map: counts
                .into_iter()
                .map(|count| (count != NO_VOXEL).then_some(count))
                .collect(),
        }
    }
}

/// A column, in order of id.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnData {
    pub name: &'static str,
    pub values: Values,
}

#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    Float(Vec<f32>),
    Unsigned(Vec<u32>),
    /// So many numbers per particle.
    Vector {
        columns: usize,
        values: Vec<f32>,
    },
    /// So many numbers per particle; positions, which stay exact far from zero.
    Double {
        columns: usize,
        values: Vec<f64>,
    },
}

/// Device buffers that the wanted columns are made from, in a fixed order.
pub(super) fn sources(columns: &[Column]) -> Vec<&'static str> {
    let mut names = Vec::new();
    if columns.is_empty() {
        return names;
    }
    names.extend(["id", "position", "velocity"]);
    let own = columns.iter().filter(|column| column.is_field());
    names.extend(own.map(|column| column.name));
    names
}

/// The wanted columns in order of id, from the device's bytes by buffer name.
pub(super) fn columns(scene: &Scene, plan: &Plan, raw: &BTreeMap<&str, &[u8]>) -> Vec<ColumnData> {
    let Some(ids) = raw.get("id") else {
        return Vec::new();
    };
    let ids: Vec<u32> = bytemuck::pod_collect_to_vec(ids);
    let free = ids.iter().filter(|&&id| id < scene.first_boundary()).count();
    let mut slot_of = vec![0usize; free];
    for (slot, &id) in ids.iter().enumerate() {
        if let Some(place) = slot_of.get_mut(id as usize) {
            *place = slot;
        }
    }
    let dimensions = scene.dimensions.count();
    let position: Vec<Packed> = bytemuck::pod_collect_to_vec(raw["position"]);
    let velocity: Vec<Packed> = bytemuck::pod_collect_to_vec(raw["velocity"]);
    let vector = |from: &[Packed], slot: usize| {
        let [x, y, z, _] = from[slot];
        glam::Vec3::new(x, y, z)
    };
    let global = |slot: usize| -> DVec3 { vector(&position, slot).as_dvec3() + scene.origin };
    let floats =
        |of: &dyn Fn(usize) -> f64| Values::Float(slot_of.iter().map(|&slot| of(slot) as f32).collect());
    let column = |column: &Column| {
        let values = match column.name {
            "position" => Values::Double {
                columns: dimensions,
                values: slot_of
                    .iter()
                    .flat_map(|&s| global(s).to_array().into_iter().take(dimensions))
                    .collect(),
            },
            "velocity" => Values::Vector {
                columns: dimensions,
                values: slot_of
                    .iter()
                    .flat_map(|&s| vector(&velocity, s).to_array().into_iter().take(dimensions))
                    .collect(),
            },
            "id" => Values::Unsigned((0..free as u32).collect()),
            "speed" => floats(&|s| f64::from(vector(&velocity, s).length())),
            "x" => floats(&|s| global(s).x),
            "y" => floats(&|s| global(s).y),
            "z" => floats(&|s| global(s).z),
            "velocity_x" => floats(&|s| f64::from(vector(&velocity, s).x)),
            "velocity_y" => floats(&|s| f64::from(vector(&velocity, s).y)),
            "velocity_z" => floats(&|s| f64::from(vector(&velocity, s).z)),
            "slice" => {
                let slice = |&s: &usize| plan.grid.slice_of(vector(&position, s));
                Values::Unsigned(slot_of.iter().map(slice).collect())
            }
            field if scene.kind_of(field) == Kind::Vector => {
                let values: Vec<Packed> = bytemuck::pod_collect_to_vec(raw[field]);
                // Three numbers in 2D too: what turns there turns about z.
                Values::Vector {
                    columns: 3,
                    values: slot_of
                        .iter()
                        .flat_map(|&s| vector(&values, s).to_array())
                        .collect(),
                }
            }
            field if scene.kind_of(field) == Kind::Unsigned => {
                let values: Vec<u32> = bytemuck::pod_collect_to_vec(raw[field]);
                Values::Unsigned(slot_of.iter().map(|&s| values[s]).collect())
            }
            field => {
                let values: Vec<f32> = bytemuck::pod_collect_to_vec(raw[field]);
                floats(&|s| f64::from(values[s]))
            }
        };
        ColumnData {
            name: column.name,
            values,
        }
    };
    plan.wanted.columns.iter().map(column).collect()
}
