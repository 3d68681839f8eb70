//! Structs that the shaders of `surface` share with the host.

use crate::shared_struct;

shared_struct! {
    /// Lengths are metres, places as the search has them.
    pub struct Surface {
        /// Place of node 0.
        pub lower: [f32; 4],
        /// Sides of the domain; far away where there are none.
        pub low: [f32; 4],
        pub high: [f32; 4],
        /// Of a voxel.
        pub width: f32,
        /// Of the weights.
        pub reach: f32,
        /// From the particles' weighted mean to the surface.
        pub radius: f32,
        /// From the nearest particle to the surface.
        pub farthest: f32,
        /// Particles nearer to the mean of their neighbors lie deep inside.
        pub deep: f32,
        /// Particles near the surface.
        pub shell: u32,
        pub voxels: u32,
        pub vertices: u32,
        /// Of the particles.
        pub spacing: f32,
        /// How far away a neighbor may be.
        pub neighbor_reach: f32,
        /// Particles with fewer neighbors have no part in the surface.
        pub fewest: f32,
        pub reserved: u32,
    }
}

shared_struct! {
    pub struct SurfaceTotals {
        /// Particles near the surface.
        pub shell: u32,
        pub vertices: u32,
        pub triangles: u32,
        /// Edges through the surface with a cell around them that is not complete.
        pub open: u32,
    }
}
