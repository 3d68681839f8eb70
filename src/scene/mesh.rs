//! Triangle meshes: where they stand, whether they are closed, which side is out.
//!
//! `load` reads files, [`surface`] answers where the inside is and how far the surface.

mod load;
#[cfg(test)]
pub(crate) mod samples;
pub mod surface;
#[cfg(test)]
mod tests;

use std::collections::HashMap;
use std::path::Path;

use glam::{DMat3, DVec3};

#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// Metres.
    pub vertices: Vec<DVec3>,
    /// Counterclockwise, seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Reads an OBJ, PLY or STL file, welds its vertices and turns its faces outward. It may still have holes.
    pub fn load(path: &Path) -> Result<Mesh, String> {
        load::load(path)
    }

    /// Scaled along each axis, by factors above zero, then turned about x, then y, then z, then moved by `translate` metres.
    pub fn placed(mut self, scale: DVec3, rotate_degrees: DVec3, translate: DVec3) -> Mesh {
        let angle = rotate_degrees.map(f64::to_radians);
        let turn = DMat3::from_rotation_z(angle.z)
            * DMat3::from_rotation_y(angle.y)
            * DMat3::from_rotation_x(angle.x);
        for vertex in &mut self.vertices {
            *vertex = turn * (*vertex * scale) + translate;
        }
        self
    }

    /// Lower and upper corner, metres; (∞, −∞) without vertices.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        self.vertices
            .iter()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &vertex| {
                (low.min(vertex), high.max(vertex))
            })
    }

    /// Edges that bound more triangles on one side than on the other; 0 means closed, so that an inside exists.
    pub fn open_edges(&self) -> usize {
        self.half_edges()
            .chunk_by(|a, b| a.ends == b.ends)
            .filter(|edge| edge.iter().map(|half| half.direction).sum::<i32>() != 0)
            .count()
    }

    /// m³; negative when the faces look inward. Meaningful for a closed mesh.
    pub fn signed_volume(&self) -> f64 {
        let origin = self.vertices.first().copied().unwrap_or_default();
        let corner = |index: u32| self.vertices[index as usize] - origin;
        self.triangles
            .iter()
            .map(|&[a, b, c]| corner(a).dot(corner(b).cross(corner(c))) / 6.0)
            .sum()
    }

    /// Joins vertices at the same place and drops the triangles that lose their area by it.
    fn welded(self) -> Mesh {
        let mut places = HashMap::with_capacity(self.vertices.len());
        let mut vertices = Vec::new();
        let mut joined = Vec::with_capacity(self.vertices.len());
        for vertex in self.vertices {
            // Adding zero makes -0 and 0 one place.
            let place = (vertex + DVec3::ZERO).to_array().map(f64::to_bits);
            joined.push(*places.entry(place).or_insert_with(|| {
                vertices.push(vertex);
                vertices.len() as u32 - 1
            }));
        }
        let triangles = self
            .triangles
            .iter()
            .map(|triangle| triangle.map(|index| joined[index as usize]))
            .filter(|[a, b, c]| a != b && b != c && c != a)
            .collect();
        Mesh { vertices, triangles }
    }

    /// Turns all faces the same way within each connected part if they are not, and the whole outward.
    ///
    /// A mesh whose faces agree keeps its parts as they are: an inner shell that looks inward bounds a cavity.
    fn oriented(mut self) -> Mesh {
        if self.open_edges() > 0 {
            self.make_faces_agree();
        }
        if self.signed_volume() < 0.0 {
            self.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        self
    }

    /// Walks over edges with exactly two triangles and flips those that disagree with where the walk came from; turns
    /// each part outward.
    fn make_faces_agree(&mut self) {
        let mut neighbors = vec![Vec::new(); self.triangles.len()];
        for edge in self.half_edges().chunk_by(|a, b| a.ends == b.ends) {
            if let [a, b] = edge {
                let agree = a.direction != b.direction;
                neighbors[a.triangle].push((b.triangle, agree));
                neighbors[b.triangle].push((a.triangle, agree));
            }
        }

        let mut flip = vec![None; self.triangles.len()];
        for seed in 0..self.triangles.len() {
            if flip[seed].is_some() {
                continue;
            }
            flip[seed] = Some(false);
            let mut part = vec![seed];
            let mut reached = 0;
            while let Some(&here) = part.get(reached) {
                reached += 1;
                for &(there, agree) in &neighbors[here] {
                    if flip[there].is_none() {
                        flip[there] = flip[here].map(|flipped: bool| flipped == agree);
                        part.push(there);
                    }
                }
            }

            for &member in &part {
                if flip[member] == Some(true) {
                    self.triangles[member].swap(1, 2);
                }
            }
            let members = Mesh {
                vertices: std::mem::take(&mut self.vertices),
                triangles: part.iter().map(|&member| self.triangles[member]).collect(),
            };
            if members.signed_volume() < 0.0 {
                for &member in &part {
                    self.triangles[member].swap(1, 2);
                }
            }
            self.vertices = members.vertices;
        }
    }

    /// Every triangle's three edges; those between the same two vertices stand side by side.
    fn half_edges(&self) -> Vec<HalfEdge> {
        let mut halves: Vec<HalfEdge> = self
            .triangles
            .iter()
            .enumerate()
            .flat_map(|(triangle, &[a, b, c])| {
                [(a, b), (b, c), (c, a)].map(|(from, to)| HalfEdge {
                    ends: [from.min(to), from.max(to)],
                    triangle,
                    direction: if from < to { 1 } else { -1 },
                })
            })
            .collect();
        halves.sort_unstable_by_key(|half| (half.ends, half.triangle));
        halves
    }
}

/// A triangle's side.
struct HalfEdge {
    /// Lower vertex first.
    ends: [u32; 2],
    triangle: usize,
    /// 1 when the triangle runs from the lower vertex to the higher, -1 when back.
    direction: i32,
}
