//! The grid that a surface is stored in.

use super::maker::mark_side;
use super::{Lattice, Shape};
use crate::gpu::Variant;
use crate::neighbors::{Grid, Room, Search};
use crate::scene::model::Axis;

/// Entries of tables to begin with.
const FIRST_ROOM: u32 = 1 << 16;

/// The grid of a surface's voxels, whose slices lie across y, with the room that one before it had.
pub fn grid(lattice: &Lattice, shape: &Shape, before: Room) -> Grid {
    let [x, y, z] = lattice.size.map(|n| n as i32);
    let most = |entries: u64, before: u32| entries.min(before.max(FIRST_ROOM).into()) as u32;
    let rows = y as u64 * z as u64;
    Grid {
        lower: lattice.lower.extend(0.0).into(),
        size: [x, y, z, 1],
        high: [x, y, z, 0],
        inverse_side: (1.0 / shape.width) as f32,
        side: shape.width as f32,
        axis: Axis::Y as u32,
        ..Grid::default()
    }
    .with_room(Room {
        // Voxels are counted before there is memory for them.
        voxels: u32::MAX,
        rows: most(rows, before.rows),
        words: most(rows * (x as u64).div_ceil(32), before.words),
        ..Room::default()
    })
}

/// What lays out the voxels.
pub fn layout(shape: &Shape, grid: Grid, variant: &mut Variant) -> Search {
    let search = Search::of_voxels(shape.addressing, grid, variant);
    variant
        .role("marks", "surface/marks")
        .flag("two_dimensional", false)
        .constant("MARK_SIDE", mark_side(shape));
    search
}
