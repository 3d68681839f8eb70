//! Neighbor search = addressing × storage: which voxel a point falls in, and how a voxel keeps its particles.
//!
//! Physics sees three things, whatever stands behind them: `RANGES`, `candidate_range(home, k)` and
//! `candidate(slot)`. A row of [`ADDRESSINGS`] or [`STORAGES`] and its shader files are all that a new way needs.

pub mod addressing;
pub mod grid;
pub mod storage;

pub use addressing::ADDRESSINGS;
pub use grid::Grid;
pub use storage::STORAGES;

use crate::gpu::{BufferPlan, PassPlan, Variant};
use crate::scene::{Neighbors, Scene};

/// The buffers and passes of a scene's neighbor search. The passes read `next_position` and the other `next_` columns
/// and leave the particles in `position` and so on, with the grid made for them.
pub struct Search {
    pub grid: Grid,
    pub buffers: Vec<BufferPlan>,
    pub passes: Vec<PassPlan>,
}

/// The search that a scene asks for; sets the roles `<addressing>` and `<storage>` of `variant`.
pub fn plan(scene: &Scene, variant: &mut Variant) -> Search {
    let Neighbors {
        addressing,
        storage,
        slots,
        slicing_axis,
    } = scene.neighbors;
    let grid = Grid::new(scene);
    let addressing = addressing::row(addressing);
    let storage = storage::row(storage);
    variant
        .role("addressing", addressing.query)
        .role("storage", storage.query)
        .constant("SLOTS", slots)
        .constant("REACH", 1)
        .flag("slicing_axis_x", slicing_axis == crate::scene::model::Axis::X)
        .flag("slicing_axis_z", slicing_axis == crate::scene::model::Axis::Z);
    let mut search = Search {
        buffers: vec![BufferPlan::uniform(
            "grid",
            Grid::LAYOUT.size,
            "place and size of the voxels",
        )],
        passes: Vec::new(),
        grid,
    };
    (addressing.plan)(&mut search);
    (storage.plan)(&mut search, scene.capacity, slots);
    search
}
