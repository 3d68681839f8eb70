//! The voxels' place and size.

use glam::{DVec3, Vec3};

use super::lists;
use super::room::Room;
use crate::scene::model::{Axis, Cell, Wall};
use crate::scene::{Dimensions, Scene};
use crate::shared_struct;

shared_struct! {
    /// `Grid` of `cells/grid.wgsl`; vectors stand in the order (u, s, w).
    pub struct Grid {
        /// Lower corner of voxel 0, metres.
        pub lower: [f32; 4],
        /// Voxels of the domain along u, s, w; 1 along w in 2D.
        pub size: [i32; 4],
        /// Lowest voxel coordinates that the search follows. For `morton`, the fourth is the bits of a block's side.
        pub low: [i32; 4],
        /// One above the highest. For `morton`, blocks along each direction.
        pub high: [i32; 4],
        /// 1/m.
        pub inverse_side: f32,
        /// Metres.
        pub side: f32,
        /// That slices are cut across: 0 x, 1 y, 2 z.
        pub axis: u32,
        /// Voxels that the buffers have room for.
        pub capacity: u32,
        /// Rows that the tables have room for.
        pub row_capacity: u32,
        /// Words of 32 voxels that the bitmap has room for.
        pub word_capacity: u32,
        /// Neighbors that a list has room for.
        pub list_capacity: u32,
        /// Steps of a frame.
        pub frame_steps: u32,
        /// Of lists, metres: the search radius and the skin.
        pub list_reach: f32,
        /// Square of how far a particle may come from where its list expects it, m².
        pub list_move: f32,
        /// Boundary particles in reach of fluid that there is room for.
        pub reached_capacity: u32,
        /// Where lists expect straight paths: square of the way that a particle may go while its list serves, m².
        pub list_way: f32,
        /// The same: how long the first lists look ahead, s.
        pub list_horizon: f32,
        pub _pad: [u32; 3],
        /// In (x, y, z) order: lengths after which space repeats, metres; 0 along directions where it does not.
        pub period: [f32; 4],
        /// 1/m; 0 along those directions.
        pub inverse_period: [f32; 4],
        /// Lower corner of what repeats, metres.
        pub period_lower: [f32; 4],
    }
}

/// Particles count as moved too far a little early, so that rounding loses no neighbor.
const MOVE_ROUNDING: f64 = 1e-3;

/// A voxel's coordinates in the order (u, s, w).
pub type Voxel = [i32; 3];

impl Grid {
    /// Voxels over the scene's domain and as far beyond its open sides as the search follows particles, with slices
    /// across `axis` and no room yet.
    ///
    /// Voxels are as wide as lists look (half of it with [`Cell::Half`]) and a little more: two points within
    /// the radius are at most one voxel (two) apart as long as rounding moves a scaled coordinate by less than half of
    /// what the side is wider. Coordinates up to n voxels carry an error below 1.5·2⁻²³·n each, so the side is wider
    /// by n·2⁻²¹.
    pub fn new(scene: &Scene, axis: Axis) -> Self {
        let radius = scene.search_radius();
        let skin = radius * scene.neighbors.skin;
        let paths = lists::straight_paths(scene);
        let way = skin + paths.map_or(0.0, |paths| paths.reach);
        let reach = (radius + way) / f64::from(voxel_reach(scene));
        let domain = &scene.domain;
        let (min, max) = searched(scene);
        let extent = max - min;
        let eight_sides = 8.0 * extent.max_element();
        let follow = scene.neighbors.quarantine_distance.unwrap_or(eight_sides);
        let open = |axis: usize, end: usize| match domain.sides[axis][end] {
            Wall::Open => follow,
            _ => 0.0,
        };
        let sides = [0, 1].map(|end| DVec3::from([0, 1, 2].map(|axis| open(axis, end))));
        let widest = ((extent + sides[0].max(sides[1])).max_element() / reach)
            .ceil()
            .max(2.0);
        let side = reach * (1.0 + widest * f64::from(f32::EPSILON) * 4.0);
        let along = |length: f64| ((length / side).ceil() as i32).max(1);
        let flat = scene.dimensions == Dimensions::Two;
        let mut size = permuted(extent, axis).map(along);
        // What overlaps a closed side lies beyond it by less than a radius.
        let [mut below, mut beyond] =
            sides.map(|follow| permuted(follow, axis).map(|x| (x / side).ceil() as i32 + 2));
        if flat {
            (size[2], below[2], beyond[2]) = (1, 0, 0);
        }
        let lower = permuted(min, axis).map(|x| x as f32);
        let inverse = |length: f32| if length > 0.0 { 1.0 / length } else { 0.0 };
        let four = |v: [i32; 3], last| [v[0], v[1], v[2], last];
        let half_of = |way: f64| (0.5 * way * (1.0 - MOVE_ROUNDING)).powi(2) as f32;
        Self {
            lower: [lower[0], lower[1], lower[2], 0.0],
            size: four(size, 1),
            low: four(below.map(|n| -n), 0),
            high: four([0, 1, 2].map(|k| size[k] + beyond[k]), 0),
            inverse_side: (1.0 / side) as f32,
            side: side as f32,
            axis: axis_number(axis),
            frame_steps: scene.time.steps_per_frame,
            list_reach: (radius + skin) as f32,
            list_move: half_of(skin),
            list_way: half_of(way),
            list_horizon: paths.map_or(0.0, |paths| paths.horizon) as f32,
            period: domain.period().extend(0.0).into(),
            inverse_period: Vec3::from(domain.period().to_array().map(inverse))
                .extend(0.0)
                .into(),
            period_lower: domain.min.extend(0.0).into(),
            ..Default::default()
        }
    }

    /// The same grid with room for so much.
    pub fn with_room(self, room: Room) -> Self {
        Self {
            capacity: room.voxels,
            row_capacity: room.rows,
            word_capacity: room.words,
            list_capacity: room.list,
            reached_capacity: room.reached,
            ..self
        }
    }

    pub fn room(&self) -> Room {
        Room {
            voxels: self.capacity,
            rows: self.row_capacity,
            words: self.word_capacity,
            list: self.list_capacity,
            reached: self.reached_capacity,
        }
    }

    /// Voxels of the whole domain.
    pub fn domain_voxels(&self) -> u64 {
        self.size.iter().map(|&n| n as u64).product()
    }

    /// Slices that the search follows.
    pub fn slices(&self) -> u32 {
        (self.high[1] - self.low[1]) as u32
    }

    /// The voxel of a local position, with the same arithmetic as the shaders; `None` for a particle that the search
    /// does not follow.
    pub fn voxel(&self, position: Vec3) -> Option<Voxel> {
        let point = permuted_f32(position, self.axis);
        let scaled = [0, 1, 2].map(|k| ((point[k] - self.lower[k]) * self.inverse_side).floor());
        let flat = self.low[2] == 0 && self.high[2] == 1;
        let followed = |k: usize| {
            (flat && k == 2) || (scaled[k] >= self.low[k] as f32 && scaled[k] < self.high[k] as f32)
        };
        let voxel = scaled.map(|x| x as i32);
        (followed(0) && followed(1) && followed(2)).then_some([
            voxel[0],
            voxel[1],
            if flat { 0 } else { voxel[2] },
        ])
    }

    /// The voxel of a local position in a grid over the domain alone: points beyond belong to the voxels at its
    /// border.
    pub fn voxel_in_domain(&self, position: Vec3) -> Voxel {
        let point = permuted_f32(position, self.axis);
        [0, 1, 2].map(|k| {
            let scaled = ((point[k] - self.lower[k]) * self.inverse_side).floor();
            scaled.clamp(0.0, (self.size[k] - 1) as f32) as i32
        })
    }

    /// Coordinate along the slicing axis of a local position's voxel.
    pub fn slice_of(&self, position: Vec3) -> u32 {
        self.voxel_in_domain(position)[1] as u32
    }
}

/// Corners of the domain and of the layers of boundary particles beyond its sides, metres.
fn searched(scene: &Scene) -> (DVec3, DVec3) {
    let depth = |axis: usize, end: usize| match scene.domain.sides[axis][end] {
        Wall::Particles if axis < scene.dimensions.count() => scene.boundary.depth,
        _ => 0.0,
    };
    let [below, beyond] = [0, 1].map(|end| DVec3::from([0, 1, 2].map(|axis| depth(axis, end))));
    (
        scene.domain.min.as_dvec3() - below,
        scene.domain.max.as_dvec3() + beyond,
    )
}

/// Voxels that a neighbor can be away along one direction: `REACH` in shaders.
pub fn voxel_reach(scene: &Scene) -> u32 {
    match scene.neighbors.cell {
        Cell::Radius => 1,
        Cell::Half => 2,
    }
}

fn axis_number(axis: Axis) -> u32 {
    match axis {
        Axis::X => 0,
        Axis::Y => 1,
        Axis::Z => 2,
    }
}

/// Components in the order (u, s, w): fastest in memory, across slices, the third.
fn permuted(v: DVec3, axis: Axis) -> [f64; 3] {
    match axis {
        Axis::X => [v.y, v.x, v.z],
        Axis::Y => [v.x, v.y, v.z],
        Axis::Z => [v.x, v.z, v.y],
    }
}

fn permuted_f32(v: Vec3, axis: u32) -> [f32; 3] {
    match axis {
        0 => [v.y, v.x, v.z],
        2 => [v.x, v.z, v.y],
        _ => [v.x, v.y, v.z],
    }
}
