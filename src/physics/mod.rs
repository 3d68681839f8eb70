//! Solvers: parameters and an ordered list of passes each. None knows the grid.

pub mod collider;
pub mod dem;
pub mod fluid;
pub mod kernels;
pub mod layout;

use crate::gpu::{BufferPlan, PassPlan};

/// What a solver contributes to a plan, around the neighbor search of a step.
#[derive(Default)]
pub struct Solver {
    pub buffers: Vec<BufferPlan>,
    /// From `position` and the other columns to `next_position` and so on.
    pub before_search: Vec<PassPlan>,
    /// On the particles as the search left them.
    pub after_search: Vec<PassPlan>,
    /// Once a frame, when somebody asks for what it measures.
    pub measure: Vec<PassPlan>,
}
