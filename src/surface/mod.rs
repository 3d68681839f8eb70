//! A surface around particles, made on the device: the implicit function of the particles is stored in the voxels of a grid
//! made for that moment, `sliced`, `rows` or `bitmap`, whose memory follows what is near the surface, and marching cubes make a
//! mesh of it. The same particles give the same bytes.
//!
//! The wish is Harada 2007's (Section 8): its grid should hold an implicit function that a surface is made from.

mod cubes;
pub mod layout;
mod maker;
mod voxels;

use glam::Vec3;

use crate::scene::model::{Addressing, SurfaceKernel};

pub use maker::{Figures, Mesh, Searched, SurfaceMaker, variants};

/// Addressings that a surface can be stored by.
pub const ADDRESSINGS: [Addressing; 3] = [Addressing::Bitmap, Addressing::Rows, Addressing::Sliced];

/// From a point to the particles that have a weight there, in spacings. The farther, the smoother, and the larger are drops.
const REACH: f64 = 2.5;
/// From the nearest particle to the surface, in spacings.
const FARTHEST: f64 = 1.2;
/// Particles whose neighbors' weighted mean is nearer, in spacings, lie deep inside.
const DEEP: f64 = 0.15;

/// The search radius that suits particles so far apart, metres.
pub fn usual_reach(spacing: f64) -> f64 {
    REACH * spacing
}

/// From the particles' weighted mean to the surface, metres. Above a lattice's half space the surface is then half a spacing
/// above the topmost particles, for weights that reach 2 to 4 spacings. With the usual reach that is 0.66 spacings, and a
/// particle alone gets 1.2 times its volume.
fn radius(spacing: f64, reach: f64) -> f64 {
    0.081 * spacing + 0.232 * reach
}

/// How a surface is made.
#[derive(Debug, Clone, Copy)]
pub struct Shape {
    /// Between particles, metres.
    pub spacing: f64,
    /// Of the particles' weights, metres: no farther than they were searched for.
    pub reach: f64,
    /// Width of a voxel, metres.
    pub width: f64,
    pub addressing: Addressing,
    pub kernel: SurfaceKernel,
    /// Particles that have no part in the surface; none is left out where there are none.
    pub drops: Option<Drops>,
    /// Where the domain's sides are, in the search's coordinates, metres; none where particles leave it.
    pub sides: [[Option<f64>; 2]; 3],
}

/// Particles with so few neighbors that they are drops, apart from the surface.
#[derive(Debug, Clone, Copy)]
pub struct Drops {
    /// How far away a neighbor may be, metres.
    pub reach: f64,
    /// One with fewer is a drop.
    pub fewest: f64,
}

/// The box of voxels around a surface.
#[derive(Debug, Clone, Copy)]
pub struct Lattice {
    /// Place of node 0, in the search's coordinates, metres.
    pub lower: Vec3,
    /// Nodes along each axis.
    pub size: [u32; 3],
}

/// Nodes along a side that there can be.
pub const MOST_NODES: u32 = 65_534;

/// Empty voxels around the surface.
pub fn margin(shape: &Shape) -> f64 {
    FARTHEST * shape.spacing + 2.0 * shape.width
}
