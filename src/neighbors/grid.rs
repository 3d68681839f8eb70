//! The voxels' place and size.

use glam::Vec3;

use crate::scene::model::Axis;
use crate::scene::{Dimensions, Scene};
use crate::shared_struct;

shared_struct! {
    /// `Grid` of `cells/grid.wgsl`; vectors stand in the order (u, s, w).
    pub struct Grid {
        /// Lower corner of voxel 0, metres.
        pub lower: [f32; 4],
        /// Voxels along u, s, w; 1 along w in 2D.
        pub size: [i32; 4],
        /// 1/m.
        pub inverse_side: f32,
        /// Metres.
        pub side: f32,
        /// Voxels that the buffers have room for.
        pub capacity: u32,
        pub _pad: u32,
    }
}

impl Grid {
    /// Voxels over the scene's domain, as wide as a grain and a little more.
    ///
    /// Two grains that touch are at most one voxel apart as long as rounding moves a scaled coordinate by less than
    /// half of what the side is wider: coordinates up to n voxels carry an error below 1.5·2⁻²³·n each, so the side
    /// is wider by n·2⁻²¹.
    pub fn new(scene: &Scene) -> Self {
        let reach = 2.0 * scene.grains.radius;
        let extent = (scene.domain.max - scene.domain.min).as_dvec3();
        let widest = (extent.max_element() / reach).ceil().max(2.0);
        let side = reach * (1.0 + widest * f64::from(f32::EPSILON) * 4.0);
        let axis = scene.neighbors.slicing_axis;
        let along = |length: f64| ((length / side).ceil() as i32).max(1);
        let size = permuted(extent, axis).map(along);
        let depth = match scene.dimensions {
            Dimensions::Two => 1,
            Dimensions::Three => size[2],
        };
        let lower = permuted(scene.domain.min.as_dvec3(), axis).map(|x| x as f32);
        Self {
            lower: [lower[0], lower[1], lower[2], 0.0],
            size: [size[0], size[1], depth, 1],
            inverse_side: (1.0 / side) as f32,
            side: side as f32,
            capacity: size[0].saturating_mul(size[1]).saturating_mul(depth) as u32,
            _pad: 0,
        }
    }

    /// Slices that the grid has.
    pub fn slices(&self) -> u32 {
        self.size[1] as u32
    }

    /// Rows of voxels along u that the grid has.
    pub fn rows(&self) -> u32 {
        (self.size[1] * self.size[2]) as u32
    }

    /// Coordinate along the slicing axis of a local position's voxel; the same arithmetic as in the shader.
    pub fn slice_of(&self, position: Vec3, axis: Axis) -> u32 {
        let along = permuted(position.as_dvec3(), axis)[1] as f32;
        let scaled = ((along - self.lower[1]) * self.inverse_side).floor();
        scaled.clamp(0.0, (self.size[1] - 1) as f32) as u32
    }
}

/// Components in the order (u, s, w): fastest in memory, across slices, the third.
pub fn permuted(v: glam::DVec3, axis: Axis) -> [f64; 3] {
    match axis {
        Axis::X => [v.y, v.x, v.z],
        Axis::Y => [v.x, v.y, v.z],
        Axis::Z => [v.x, v.z, v.y],
    }
}
