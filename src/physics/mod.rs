//! Solvers: parameters and an ordered list of passes each. None knows the grid.

pub mod bodies;
pub mod collider;
pub mod dem;
pub mod dfsph;
pub mod fields;
mod floating;
pub mod fluid;
pub mod formulas;
pub mod guard;
mod implicit_viscosity;
pub mod kernels;
pub mod layout;
mod model;
pub mod sensors;
pub mod step_control;

pub use model::{FromState, MODELS, Model, OwnFigures, Request, Solver, Written, model};

use crate::gpu::{Items, PassPlan};

/// Last pass of a velocity Verlet step.
fn kick() -> PassPlan {
    let why = "corrects the predicted velocities";
    PassPlan::new("physics/kick", "kick", Items::Particles, why)
}
