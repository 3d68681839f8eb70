//! What surfaces end at: sides of the domain, and obstacles.

use glam::{DVec3, Vec3};

use crate::physics::collider::offset_at;
use crate::scene::obstacles::Obstacle;
use crate::scene::{Dimensions, Scene};

/// Copies of particles that stand beyond a side, one behind the other; so many that the mesh's rounded end stays behind it.
const LAYERS: u32 = 3;
/// Particles nearer to a side than that share of their spacing are copied.
const FIRST_LAYER: f64 = 0.8;
/// Vertices deeper in an obstacle than so many spacings stay where they are: fluid leaks there, and nothing is hidden.
const DEEPEST: f64 = 2.0;

/// The walls of a scene, in its own coordinates.
#[derive(Default)]
pub struct Walls<'a> {
    /// Where the domain's sides stand along each axis, metres; none where particles leave it.
    sides: [[Option<f64>; 2]; 3],
    obstacles: Vec<(Obstacle<'a>, &'a [(f64, Vec3)])>,
    /// Metres.
    origin: DVec3,
    fps: f64,
}

impl<'a> Walls<'a> {
    pub fn of(scene: &'a Scene) -> Self {
        let ends = scene.domain.ends();
        let global = |axis: usize| ends[axis].map(|end| end.map(|end| f64::from(end) + scene.origin[axis]));
        let obstacle = |collider: &'a crate::scene::Collider| {
            (
                Obstacle::new(&collider.shape, Dimensions::Three),
                collider.path.as_slice(),
            )
        };
        Self {
            sides: [0, 1, 2].map(global),
            obstacles: scene.colliders.iter().map(obstacle).collect(),
            origin: scene.origin,
            fps: scene.time.fps,
        }
    }

    /// Where the domain's sides stand along each axis, metres; none where particles leave it.
    pub fn sides(&self) -> [[Option<f64>; 2]; 3] {
        self.sides
    }

    /// Copies of particles beyond sides, so that a surface goes straight on through them: whose copy, and where, metres.
    pub fn copies(&self, position: &[DVec3], spacing: f64) -> Vec<(usize, DVec3)> {
        let mut all: Vec<(usize, DVec3)> = position.iter().copied().enumerate().collect();
        for (axis, sides) in self.sides.iter().enumerate() {
            let mut copies = Vec::new();
            for (side, out) in sides.iter().zip([-1.0, 1.0]) {
                let Some(side) = side else { continue };
                let is_first = |p: &DVec3| ((side - p[axis]) * out).abs() < FIRST_LAYER * spacing;
                for (source, place) in all.iter().filter(|(_, p)| is_first(p)) {
                    copies.extend((1..=LAYERS).map(|layer| {
                        let mut copy = *place;
                        copy[axis] += out * f64::from(layer) * spacing;
                        (*source, copy)
                    }));
                }
            }
            all.extend(copies);
        }
        all.split_off(position.len())
    }

    /// Moves a vertex onto the sides beyond which it is; says which way each looks, outward: 0 along axes without one.
    pub fn clamp(&self, vertex: &mut DVec3) -> DVec3 {
        let mut outward = DVec3::ZERO;
        for (axis, [low, high]) in self.sides.iter().enumerate() {
            for (side, out) in [(low, -1.0), (high, 1.0)] {
                let Some(side) = *side else { continue };
                if (vertex[axis] - side) * out > 0.0 {
                    vertex[axis] = side;
                    outward[axis] = out;
                }
            }
        }
        outward
    }

    /// Where a vertex in an obstacle comes out of it, at a frame.
    pub fn way_out(&self, vertex: DVec3, frame: u32, spacing: f64) -> DVec3 {
        let time = f64::from(frame) / self.fps.max(f64::MIN_POSITIVE);
        self.obstacles.iter().fold(vertex, |vertex, (obstacle, path)| {
            let to_global = self.origin + offset_at(path, time).as_dvec3();
            obstacle
                .way_out(vertex - to_global, DEEPEST * spacing)
                .map_or(vertex, |out| out + to_global)
        })
    }
}
