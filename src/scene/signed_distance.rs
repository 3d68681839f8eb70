//! The distance to a mesh, sampled on a grid: how the device sees a mesh obstacle.

use std::num::NonZero;
use std::thread;

use glam::DVec3;

use super::mesh::{Mesh, surface::Surface};

#[derive(Debug, Clone, PartialEq)]
pub struct SignedDistance {
    /// Where the first node stands, metres.
    pub min: DVec3,
    /// Distance of nodes, metres.
    pub cell: f64,
    /// Nodes along x, y and z; at least 2 each.
    pub size: [u32; 3],
    /// Metres, negative inside; x fastest, then y, then z.
    pub values: Vec<f32>,
}

impl SignedDistance {
    /// Distances from the nodes of a grid that reaches `margin` metres beyond the mesh; exact up to `margin`, and ±`margin`
    /// farther away. The mesh must be closed and have a face.
    pub fn new(mesh: &Mesh, cell: f64, margin: f64) -> Self {
        let min = mesh.bounds().0 - margin;
        let size = Self::size(mesh, cell, margin).as_usizevec3();
        let mut values = vec![0.0; size.element_product()];

        let surface = Surface::new(mesh);
        let workers = thread::available_parallelism().map_or(1, NonZero::get);
        let layers = size.z.div_ceil(workers);
        thread::scope(|scope| {
            for (worker, part) in values.chunks_mut(size.x * size.y * layers).enumerate() {
                let surface = &surface;
                scope.spawn(move || {
                    for (index, row) in part.chunks_mut(size.x).enumerate() {
                        let y = min.y + (index % size.y) as f64 * cell;
                        let z = min.z + (worker * layers + index / size.y) as f64 * cell;
                        fill(row, surface, DVec3::new(min.x, y, z), cell, margin);
                    }
                });
            }
        });
        Self {
            min,
            cell,
            size: size.as_uvec3().to_array(),
            values,
        }
    }

    /// Nodes of that grid along x, y and z, before it is made.
    pub fn size(mesh: &Mesh, cell: f64, margin: f64) -> DVec3 {
        let (low, high) = mesh.bounds();
        ((high + margin - (low - margin)) / cell).ceil() + 1.0
    }

    /// Metres, interpolated between the eight nodes around `point`; outside the grid, as at the grid's nearest point.
    pub fn sample(&self, point: DVec3) -> f64 {
        let size = glam::UVec3::from(self.size);
        let last = size.as_dvec3() - 1.0;
        let place = ((point - self.min) / self.cell).clamp(DVec3::ZERO, last);
        let corner = place.floor().min(last - 1.0);
        let share = place - corner;
        let [x, y, z] = corner.as_usizevec3().to_array();
        let (row, layer) = (size.x as usize, size.x as usize * size.y as usize);
        let node = |i, j, k| f64::from(self.values[(x + i) + (y + j) * row + (z + k) * layer]);
        let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
        let along_x = |j, k| mix(node(0, j, k), node(1, j, k), share.x);
        let along_xy = |k| mix(along_x(0, k), along_x(1, k), share.y);
        mix(along_xy(0), along_xy(1), share.z)
    }
}

/// The distances of one row of nodes. From node to node the distance grows by a cell at most, which bounds each search.
fn fill(row: &mut [f32], surface: &Surface, first: DVec3, cell: f64, margin: f64) {
    let line = surface.line(first.y, first.z);
    let mut reach = margin;
    for (index, value) in row.iter_mut().enumerate() {
        let point = first.with_x(first.x + index as f64 * cell);
        let distance = surface.distance(point, reach);
        reach = (distance + 1.001 * cell).min(margin);
        let signed = if line.contains(point.x) {
            -distance
        } else {
            distance
        };
        *value = signed as f32;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::mesh::samples::{ball, cube};

    /// The largest difference to `exact` over points within `margin` of the surface.
    fn error(field: &SignedDistance, margin: f64, exact: impl Fn(DVec3) -> f64) -> f64 {
        let mut worst: f64 = 0.0;
        for i in 0..=40 {
            for j in 0..=40 {
                for k in 0..=40 {
                    let point = (DVec3::new(i.into(), j.into(), k.into()) / 20.0 - 1.0) * 1.2;
                    let distance = exact(point);
                    if distance.abs() < margin {
                        worst = worst.max((field.sample(point) - distance).abs());
                    }
                }
            }
        }
        worst
    }

    #[test]
    fn a_ball_is_met_to_second_order() {
        let mesh = ball(DVec3::ZERO, 1.0, 6);
        let exact = |point: DVec3| point.length() - 1.0;
        let coarse = SignedDistance::new(&mesh, 0.1, 0.4);
        let fine = SignedDistance::new(&mesh, 0.05, 0.4);
        // Trilinear interpolation errs by at most (cell²/8)·Σ|f''| = cell²/(4·distance from the center).
        assert!(error(&coarse, 0.2, exact) < 0.1 * 0.1 / (4.0 * 0.65));
        assert!(error(&fine, 0.2, exact) < 0.05 * 0.05 / (4.0 * 0.7) + 3e-4);
    }

    #[test]
    fn nodes_of_a_box_are_exact_with_nodes_on_its_faces_edges_and_corners() {
        let half = DVec3::new(1.0, 0.5, 0.75);
        let exact = |point: DVec3| {
            let beyond = point.abs() - half;
            beyond.max(DVec3::ZERO).length() + beyond.max_element().min(0.0)
        };
        let margin = 0.25;
        let field = SignedDistance::new(&cube(-half, half), 0.125, margin);
        assert_eq!(field.size, [21, 13, 17]);
        let mut index = 0;
        for k in 0..17 {
            for j in 0..13 {
                for i in 0..21 {
                    let node = field.min + DVec3::new(i.into(), j.into(), k.into()) * field.cell;
                    let expected = exact(node).clamp(-margin, margin);
                    let found = f64::from(field.values[index]);
                    assert!((found - expected).abs() < 1e-6, "{node}: {found} {expected}");
                    assert!((field.sample(node) - found).abs() < 1e-12);
                    index += 1;
                }
            }
        }
        // Beside a face, away from its edges, the distance is linear, and so is the interpolation.
        assert!((field.sample(DVec3::new(0.03, 0.61, 0.02)) - 0.11).abs() < 1e-6);
        assert!((field.sample(DVec3::new(0.03, 9.0, 0.02)) - 0.25).abs() < 1e-6);
    }
}
