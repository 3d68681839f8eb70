//! The distance to a mesh, sampled on a grid: how the device sees a mesh obstacle.

use std::num::NonZero;
use std::thread;

use glam::{DVec3, USizeVec3};

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
        let (low, high) = mesh.bounds();
        let min = low - margin;
        let size = ((high + margin - min) / cell).ceil().as_usizevec3() + USizeVec3::ONE;
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
