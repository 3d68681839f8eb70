//! Which voxel a coordinate falls in.

use super::Search;
use crate::gpu::{BufferPlan, Items, PassPlan};
use crate::scene::model::Addressing;

/// One way to address voxels.
pub struct AddressingRow {
    pub kind: Addressing,
    pub name: &'static str,
    pub source: &'static str,
    /// Shader file that answers `address`, `span` and `voxel_total`.
    pub query: &'static str,
    /// Adds what it needs to a search.
    pub plan: fn(&mut Search),
}

pub const ADDRESSINGS: &[AddressingRow] = &[
    AddressingRow {
        kind: Addressing::Uniform,
        name: "uniform",
        source: "Green 2012; the baseline of Harada 2007",
        query: "cells/uniform",
        plan: |_| {},
    },
    AddressingRow {
        kind: Addressing::Sliced,
        name: "sliced",
        source: "Harada 2007, Eq. 1 to 5",
        query: "cells/sliced",
        plan: sliced,
    },
    AddressingRow {
        kind: Addressing::Rows,
        name: "rows",
        source: "ours: slices of slices",
        query: "cells/rows",
        plan: rows,
    },
];

/// The row of an addressing.
pub fn row(kind: Addressing) -> &'static AddressingRow {
    let found = ADDRESSINGS.iter().find(|row| row.kind == kind);
    found.expect("every addressing has a row")
}

fn sliced(search: &mut Search) {
    let slices = u64::from(search.grid.slices());
    search.buffers.extend([
        BufferPlan::storage(
            "slice_bounds",
            slices,
            16,
            "bounding box of each slice while it is found",
        ),
        BufferPlan::storage(
            "slice_record",
            slices + 1,
            16,
            "first voxel, lower corner and width of each slice (Harada 2007, Section 5.1)",
        ),
    ]);
    search.passes.extend([
        PassPlan::new(
            "cells/build_sliced",
            "bound_slices",
            Items::Particles,
            "bounding box of each slice's particles",
        ),
        PassPlan::new(
            "cells/build_sliced",
            "build_slices",
            Items::Fixed(1),
            "prefix sum of the slices' voxel counts (Harada 2007, Eq. 3)",
        ),
    ]);
}

fn rows(search: &mut Search) {
    let rows = u64::from(search.grid.rows());
    search.buffers.extend([
        BufferPlan::storage("row_bounds", rows, 8, "extent of each row while it is found"),
        BufferPlan::storage(
            "row_record",
            rows + 1,
            8,
            "first voxel of each row and its coordinate",
        ),
    ]);
    search.passes.extend([
        PassPlan::new(
            "cells/build_rows",
            "bound_rows",
            Items::Particles,
            "extent of each row's particles",
        ),
        PassPlan::new(
            "cells/build_rows",
            "build_rows",
            Items::Fixed(1),
            "prefix sum of the rows' voxel counts",
        ),
    ]);
}
