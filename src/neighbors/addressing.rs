//! Which voxel a coordinate falls in.

use super::grid::{Grid, Voxel};
use super::layout::SearchState;
use super::room::{self, Room};
use super::{REGIONS_ALONG, Search};
use crate::gpu::{BufferPlan, Items, PassPlan};
use crate::scene::model::Addressing;
use crate::scene::{Dimensions, Scene};

/// One way to address voxels.
pub struct AddressingRow {
    pub kind: Addressing,
    pub name: &'static str,
    pub source: &'static str,
    /// Shader file that answers `voxel_of`, `address`, `span` and `voxel_total`.
    pub query: &'static str,
    /// How much room it takes.
    pub room: RoomRule,
    /// Adds what it needs to a search.
    pub plan: fn(&mut Search, Space),
}

/// What an addressing asks about the space that voxels are in.
#[derive(Clone, Copy)]
pub struct Space {
    pub dimensions: Dimensions,
    /// Whether clusters get slices of their own.
    pub parted: bool,
    /// Whether the search gives up on points that are far away.
    pub is_open: bool,
}

impl Space {
    pub fn of(scene: &Scene) -> Self {
        Self {
            dimensions: scene.dimensions,
            parted: scene.neighbors.regions,
            is_open: scene.domain.is_open(),
        }
    }

    /// Slabs of slices.
    pub fn regions(self) -> u64 {
        match self.parted {
            true => u64::from(REGIONS_ALONG).pow(self.dimensions.count() as u32 - 1),
            false => 1,
        }
    }
}

/// How much room an addressing takes.
#[derive(Clone, Copy)]
pub enum RoomRule {
    /// As much, whatever the particles do; may shape the grid to its needs.
    Fixed(fn(&mut Grid, &Scene) -> Room),
    /// What the particles' voxels need; it grows on the device.
    Followed(fn(&Scene, &mut dyn Iterator<Item = Voxel>) -> Room),
}

pub const ADDRESSINGS: &[AddressingRow] = &[
    AddressingRow {
        kind: Addressing::Uniform,
        name: "uniform",
        source: "Green 2012; the baseline of Harada 2007",
        query: "cells/uniform",
        room: RoomRule::Fixed(|grid, _| whole_box(grid.domain_voxels())),
        plan: bounded,
    },
    AddressingRow {
        kind: Addressing::Sliced,
        name: "sliced",
        source: "Harada 2007, Eq. 1 to 5",
        query: "cells/sliced",
        room: RoomRule::Followed(|scene, voxels| room::of_slices(scene.neighbors.regions, voxels)),
        plan: sliced,
    },
    AddressingRow {
        kind: Addressing::Rows,
        name: "rows",
        source: "ours: slices of slices",
        query: "cells/rows",
        room: RoomRule::Followed(|_, voxels| room::of_rows(voxels)),
        plan: rows,
    },
    AddressingRow {
        kind: Addressing::Bitmap,
        name: "bitmap",
        source: "ours: one bit per voxel, memory for those that hold particles",
        query: "cells/bitmap",
        room: RoomRule::Followed(|_, voxels| room::of_bitmap(voxels)),
        plan: bitmap,
    },
    AddressingRow {
        kind: Addressing::Hash,
        name: "hash",
        source: "Teschner 2003; named by Harada 2007 and Green 2012",
        query: "cells/hash",
        room: RoomRule::Fixed(hash_table),
        plan: hash,
    },
    AddressingRow {
        kind: Addressing::Morton,
        name: "morton",
        source: "Green 2012's Z-order, Rojas 2013's Z-indexing",
        query: "cells/morton",
        room: RoomRule::Fixed(morton_blocks),
        plan: bounded,
    },
];

/// The row of an addressing.
pub fn row(kind: Addressing) -> &'static AddressingRow {
    let found = ADDRESSINGS.iter().find(|row| row.kind == kind);
    found.expect("every addressing has a row")
}

/// Extents while they are found: lowest above highest where there is nothing; pairs of them, one a direction.
const NOTHING: [i32; 2] = [i32::MAX, -i32::MAX];
const NOTHING_TWICE: [i32; 4] = [i32::MAX, i32::MAX, -i32::MAX, -i32::MAX];

fn whole_box(voxels: u64) -> Room {
    Room {
        // The plan refuses what no buffer can hold.
        voxels: u32::try_from(voxels).unwrap_or(u32::MAX - 2),
        ..Default::default()
    }
}

/// The smallest power of two that gives each particle two buckets, and no less than a search visits.
fn hash_table(_: &mut Grid, scene: &Scene) -> Room {
    whole_box((2 * u64::from(scene.capacity)).max(512).next_power_of_two())
}

/// Cubes (squares in 2D) with sides of a power of two, as large as the shortest side of the domain lets them.
fn morton_blocks(grid: &mut Grid, scene: &Scene) -> Room {
    let dimensions = scene.dimensions.count();
    let shortest = grid.size[..dimensions].iter().min().copied().unwrap_or(1) as u32;
    // Ten bits of each of three coordinates, sixteen of each of two, fill an address.
    let bits = shortest
        .next_power_of_two()
        .ilog2()
        .min(if dimensions == 2 { 15 } else { 10 });
    let blocks = [0, 1, 2].map(|k| {
        if k < dimensions {
            ((grid.size[k] - 1) >> bits) + 1
        } else {
            1
        }
    });
    grid.low[3] = bits as i32;
    grid.high = [blocks[0], blocks[1], blocks[2], 0];
    let count: u64 = blocks.iter().map(|&n| n as u64).product();
    whole_box(count << (bits * dimensions as u32))
}

/// Points beyond the domain belong to the voxels at its border.
fn bounded(search: &mut Search, _: Space) {
    search.flags.push("bounded");
}

/// What the host looks at after steps.
pub fn search_state(search: &mut Search) {
    if search.buffers.iter().any(|buffer| buffer.name == "search_state") {
        return;
    }
    search.buffers.push(
        BufferPlan::storage(
            "search_state",
            1,
            SearchState::LAYOUT.size as u64,
            "what the search needed, and whether it had room",
        )
        .holding(&[SearchState::BEFORE])
        .renewed(),
    );
}

/// Clusters of slices get slabs of their own (Harada 2007, Section 7).
fn part_regions(search: &mut Search) {
    search.flags.push("regions");
    let along = |k: usize| (search.grid.high[k] - search.grid.low[k]) as u64;
    let columns = along(0) + along(2);
    search.buffers.extend([
        BufferPlan::storage(
            "column_mark",
            columns,
            4,
            "columns of voxels that hold particles, while they are found",
        ),
        BufferPlan::storage("column_region", columns, 4, "region of each column of voxels"),
    ]);
    let build = "cells/build_regions";
    search.passes.extend([
        PassPlan::new(
            build,
            "mark_columns",
            Items::Particles,
            "columns of voxels that hold particles",
        ),
        PassPlan::new(
            build,
            "split_regions",
            Items::Fixed(1),
            "where clusters of columns begin",
        ),
    ]);
}

fn sliced(search: &mut Search, space: Space) {
    search_state(search);
    let slices = u64::from(search.grid.slices()) * space.regions();
    if space.parted {
        part_regions(search);
    }
    search.buffers.extend([
        BufferPlan::storage(
            "slice_bounds",
            slices,
            16,
            "bounding box of each slice while it is found",
        )
        .filled_with(&NOTHING_TWICE),
        BufferPlan::storage(
            "slice_record",
            slices + 1,
            16,
            "first voxel, lower corner and width of each slice (Harada 2007, Section 5.1)",
        ),
    ]);
    let build = "cells/build_sliced";
    search.passes.extend([
        PassPlan::new(
            build,
            "bound_slices",
            Items::Particles,
            "bounding box of each slice's particles",
        ),
        PassPlan::new(
            build,
            "build_slices",
            Items::Fixed(1),
            "prefix sum of the slices' voxel counts (Harada 2007, Eq. 3)",
        ),
    ]);
}

/// The table of rows, which `rows` and `bitmap` share.
fn row_table(search: &mut Search, space: Space) {
    search_state(search);
    let slices = u64::from(search.grid.slices());
    let rows = u64::from(search.grid.row_capacity);
    let build = "cells/build_rows";
    if space.dimensions == Dimensions::Three {
        search.buffers.extend([
            BufferPlan::storage(
                "slice_bounds",
                slices,
                8,
                "extent of each slice while it is found",
            )
            .filled_with(&NOTHING),
            BufferPlan::storage(
                "slice_rows",
                slices + 1,
                8,
                "first row of each slice and its coordinate",
            ),
        ]);
        search.passes.extend([
            PassPlan::new(
                build,
                "bound_slices",
                Items::Particles,
                "extent of each slice's particles",
            ),
            PassPlan::new(
                build,
                "place_rows",
                Items::Fixed(1),
                "prefix sum of the slices' row counts",
            ),
        ]);
    }
    search.buffers.extend([
        BufferPlan::storage("row_bounds", rows, 8, "extent of each row while it is found")
            .filled_with(&NOTHING),
        BufferPlan::storage(
            "row_record",
            rows + 1,
            8,
            "first voxel of each row and its coordinate",
        ),
    ]);
    search.passes.extend([
        PassPlan::new(
            build,
            "bound_rows",
            Items::Particles,
            "extent of each row's particles",
        ),
        PassPlan::new(
            build,
            "build_rows",
            Items::Fixed(1),
            "prefix sum of the rows' voxel counts",
        ),
    ]);
}

fn rows(search: &mut Search, space: Space) {
    row_table(search, space);
}

fn bitmap(search: &mut Search, space: Space) {
    search.flags.push("bitmap");
    row_table(search, space);
    let words = u64::from(search.grid.word_capacity);
    search.buffers.extend([
        BufferPlan::storage(
            "voxel_mark",
            words,
            4,
            "bits of occupied voxels while they are set",
        ),
        BufferPlan::storage(
            "voxel_word",
            words + 1,
            8,
            "bits of 32 voxels, and those set before them",
        ),
    ]);
    let build = "cells/build_bitmap";
    search.passes.extend([
        PassPlan::new(
            build,
            "mark_voxels",
            Items::Particles,
            "a bit for each voxel that holds a particle",
        ),
        PassPlan::new(build, "rank_words", Items::Fixed(1), "prefix sum of the bits"),
    ]);
}

fn hash(search: &mut Search, space: Space) {
    if !space.is_open {
        return;
    }
    search_state(search);
    let count = "cells/count_quarantined";
    search.passes.extend([
        PassPlan::new(
            count,
            "count_quarantined",
            Items::Particles,
            "particles farther than the search follows",
        ),
        PassPlan::new(count, "note_quarantined", Items::Fixed(1), "their number"),
    ]);
}
