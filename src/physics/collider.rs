//! Obstacles as the device sees them: shapes, motion, and distance fields of meshes.

use glam::Vec3;

use super::layout::Collider;
use crate::scene::signed_distance::SignedDistance;
use crate::scene::{self, ColliderShape, Scene};

/// Nodes that all distance fields together may have; more would be coarsened. 16 Mi values are 64 MiB.
const MOST_NODES: f64 = (1u64 << 24) as f64;

/// Nodes that each may have in any case.
const LEAST_NODES: f64 = 4096.0;

/// Every obstacle of a scene.
#[derive(Debug, Clone, Default)]
pub struct Obstacles {
    /// As they stand at time zero.
    pub colliders: Vec<Collider>,
    /// Signed distances of all meshes, one field after the other, metres.
    pub field: Vec<f32>,
    /// Whether one of them ever moves.
    pub moving: bool,
    pub notes: Vec<String>,
}

/// Mean velocity of a path between two times, m/s.
pub fn velocity_between(path: &[(f64, Vec3)], from: f64, to: f64) -> Vec3 {
    (offset_at(path, to) - offset_at(path, from)) / (to - from) as f32
}

impl Obstacles {
    pub fn new(scene: &Scene) -> Self {
        let mut all = Self::of_boundary_particles(scene);
        for collider in &scene.colliders {
            let described = all.describe(scene, collider);
            all.colliders.push(described);
        }
        all
    }

    /// The same for solvers that meet boundary particles instead of shapes.
    pub fn of_boundary_particles(scene: &Scene) -> Self {
        Self {
            moving: scene.colliders.iter().any(|collider| !collider.path.is_empty()),
            ..Self::default()
        }
    }

    fn describe(&mut self, scene: &Scene, collider: &scene::Collider) -> Collider {
        Collider {
            offset: packed(offset_at(&collider.path, 0.0)),
            spin: collider.spin.extend(collider.material as f32).to_array(),
            ..self.describe_shape(scene, collider)
        }
    }

    fn describe_shape(&mut self, scene: &Scene, collider: &scene::Collider) -> Collider {
        match &collider.shape {
            ColliderShape::Plane { point, normal } => Collider {
                kind: Collider::PLANE,
                a: packed(*point),
                b: packed(*normal),
                ..Default::default()
            },
            ColliderShape::Box { min, max } => Collider {
                kind: Collider::BOX,
                a: packed(*min),
                b: packed(*max),
                ..Default::default()
            },
            ColliderShape::Sphere {
                center,
                radius,
                hollow,
            } => Collider {
                kind: Collider::SPHERE,
                radius: if *hollow { -radius } else { *radius },
                a: packed(*center),
                ..Default::default()
            },
            ColliderShape::Cylinder {
                from,
                to,
                radius,
                hollow,
            } => Collider {
                kind: Collider::CYLINDER,
                radius: if *hollow { -radius } else { *radius },
                a: packed(*from),
                b: packed(*to),
                ..Default::default()
            },
            ColliderShape::Mesh(mesh) => {
                let grain = scene.radius();
                let (min, max) = mesh.bounds();
                let extent = max - min + 4.0 * grain;
                let smallest = (extent.x * extent.y * extent.z / MOST_NODES).cbrt();
                let mut cell = grain.max(smallest);
                // The margin grows with the cells, which matters for flat meshes.
                let room = (MOST_NODES - self.field.len() as f64).max(LEAST_NODES);
                let nodes =
                    |cell: f64| SignedDistance::size(mesh, cell, 2.0 * grain + 2.0 * cell).element_product();
                while nodes(cell) > 2.0 * room {
                    cell *= 1.25;
                }
                if cell > grain {
                    self.notes.push(format!(
                        "collider `{}`: its distance field has nodes every {cell:.3e} m, wider than a grain's radius, \
                         to stay below {MOST_NODES} values",
                        collider.name
                    ));
                }
                let field = SignedDistance::new(mesh, cell, 2.0 * grain + 2.0 * cell);
                let described = Collider {
                    kind: Collider::MESH,
                    field_offset: self.field.len() as u32,
                    cell: field.cell as f32,
                    a: packed(field.min.as_vec3()),
                    b: [
                        field.size[0] as f32,
                        field.size[1] as f32,
                        field.size[2] as f32,
                        0.0,
                    ],
                    ..Default::default()
                };
                self.field.extend_from_slice(&field.values);
                described
            }
        }
    }
}

fn packed(v: Vec3) -> [f32; 4] {
    v.extend(0.0).to_array()
}

/// Offset of a path at a time, seconds and metres; piecewise linear, at rest before its first and after its last point.
pub fn offset_at(path: &[(f64, Vec3)], time: f64) -> Vec3 {
    let Some(&(first_time, first)) = path.first() else {
        return Vec3::ZERO;
    };
    if time <= first_time {
        return first;
    }
    for pair in path.windows(2) {
        let ((t0, from), (t1, to)) = (pair[0], pair[1]);
        if time <= t1 {
            return from.lerp(to, ((time - t0) / (t1 - t0)) as f32);
        }
    }
    path[path.len() - 1].1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_piecewise_linear_and_rest_outside() {
        let path = [(1.0, Vec3::ZERO), (2.0, Vec3::X), (2.0, Vec3::Y), (4.0, Vec3::Z)];
        assert_eq!(offset_at(&[], 3.0), Vec3::ZERO);
        assert_eq!(offset_at(&path, 0.0), Vec3::ZERO);
        assert_eq!(offset_at(&path, 1.5), Vec3::X * 0.5);
        assert_eq!(offset_at(&path, 2.0), Vec3::X);
        assert_eq!(offset_at(&path, 3.0), Vec3::Y.midpoint(Vec3::Z));
        assert_eq!(offset_at(&path, 9.0), Vec3::Z);
    }
}
