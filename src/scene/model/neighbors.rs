//! What a user writes about the search for neighbors.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Axis;

/// How neighbors are found: which voxel a point falls in, and how a voxel keeps its particles.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Neighbors {
    /// Which voxels there are, and how one is found in memory.
    pub addressing: Addressing,
    /// How a voxel keeps its particles.
    pub storage: Storage,
    /// The axis across which slices are cut; y when left out, as in Harada 2007. With `auto` that with the fewest
    /// voxels, chosen again when the grid has to grow.
    pub slicing_axis: SlicingAxis,
    /// Whether clusters of particles with empty space between them get slices of their own (`sliced` only).
    pub regions: bool,
    /// Width of a voxel.
    pub cell: Cell,
    /// How many particles' indices a voxel of a `pool` can hold.
    #[schemars(range(min = 1, max = 64))]
    pub slots: u32,
    /// With more than 0, each particle keeps a list of its neighbors, which reaches farther than the search radius by
    /// this share of it and serves until a particle has moved by half of that; in a fluid, has strayed by half of that from the
    /// straight path that it was on. When left out, 0.1, and 0 with a `pool`, whose slots are meant for voxels as wide as the
    /// radius.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub skin: Option<f64>,
    /// Room in the grid's buffers, as a multiple of what the particles need when the buffers are made.
    #[schemars(range(min = 1.0, max = 100.0))]
    pub margin: f64,
    /// How far beyond the domain's open sides the search follows particles, metres; eight times the domain's longest
    /// side when left out. Particles beyond find no neighbors; they are counted.
    #[schemars(range(min = 0.0, max = 1e9))]
    pub quarantine_distance: Option<f64>,
    /// Whether two runs on one device give the same bytes. Without it, `counting` and `pool` take particles in the
    /// order in which the device's threads arrive, which saves work; the other storages give the same bytes anyway.
    pub deterministic: bool,
}

impl Default for Neighbors {
    fn default() -> Self {
        Self {
            addressing: Addressing::default(),
            storage: Storage::default(),
            slicing_axis: SlicingAxis::default(),
            regions: false,
            cell: Cell::default(),
            slots: 4,
            skin: None,
            margin: 1.5,
            quarantine_distance: None,
            deterministic: true,
        }
    }
}

/// Which voxels there are, and how one is found in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Addressing {
    /// The whole domain (Green 2012).
    Uniform,
    /// The bounding box of each slice (Harada 2007); as fast as `uniform` in a full box, faster in others.
    #[default]
    Sliced,
    /// The extent of each row in each slice.
    Rows,
    /// One bit per voxel in the extent of each row; memory for those voxels that hold particles.
    Bitmap,
    /// A fixed table for an unbounded space (Teschner 2003); collisions cost time.
    Hash,
    /// The whole domain along a Z-order curve (Green 2012, Rojas 2013).
    Morton,
}

/// How wide voxels are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Cell {
    /// As the search's radius: a grain's diameter (the loose grid of Green 2012); 27 voxels around a particle in 3D.
    #[default]
    Radius,
    /// Half of it: 125 voxels around a particle in 3D, with fewer candidates in them.
    Half,
}

/// The axis across which slices are cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SlicingAxis {
    /// Slices stand side by side along x.
    X,
    /// Slices lie on each other.
    #[default]
    Y,
    /// Slices stand behind each other along z.
    Z,
    /// The one that needs the fewest voxels.
    Auto,
}

impl SlicingAxis {
    /// `None` for `auto`.
    pub fn fixed(self) -> Option<Axis> {
        match self {
            Self::X => Some(Axis::X),
            Self::Y => Some(Axis::Y),
            Self::Z => Some(Axis::Z),
            Self::Auto => None,
        }
    }
}

/// How a voxel keeps its particles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Storage {
    /// Count, prefix sum, scatter: particles stand in voxel order (Green 2012).
    #[default]
    Counting,
    /// A fixed number of indices per voxel (Harada 2007's index pool).
    Pool,
    /// A radix sort by voxel: particles stand in voxel order (Green 2012).
    Radix,
    /// A bitonic merge sort by voxel: particles stand in voxel order (Rojas 2013).
    Bitonic,
}
