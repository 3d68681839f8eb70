//! Solvers: parameters and an ordered list of passes each. None knows the grid.

pub mod collider;
pub mod dem;
pub mod dfsph;
pub mod fluid;
pub mod kernels;
pub mod layout;
mod model;
pub mod pace;

pub use model::{FromState, MODELS, Model, OwnFigures, Request, Solver, Written, model};

use crate::gpu::{BufferPlan, Items, PassPlan, Variant};
use crate::scene::Scene;
use crate::scene::column::{Column, Source};

/// The buffers of those columns that are measured once a frame, each with its flag in the shaders.
fn measured(scene: &Scene, columns: &[Column], variant: &mut Variant) -> Vec<BufferPlan> {
    let measured = columns.iter().filter(|column| column.source == Source::Measured);
    let buffer = |column: &Column| {
        variant.flag(&format!("column_{}", column.name), true);
        BufferPlan::storage(column.name, u64::from(scene.capacity), 4, column.about)
    };
    measured.map(buffer).collect()
}

/// Last pass of a velocity Verlet step.
fn kick() -> PassPlan {
    let why = "corrects the predicted velocities";
    PassPlan::new("physics/kick", "kick", Items::Particles, why)
}

/// Buffers that velocity Verlet needs.
fn accelerations(scene: &Scene) -> [BufferPlan; 2] {
    let column =
        |name, why: &str| BufferPlan::storage(name, u64::from(scene.capacity), layout::PACKED_BYTES, why);
    [
        column("acceleration", "velocity Verlet needs the last accelerations"),
        column("next_acceleration", "accelerations, before reordering"),
    ]
}
