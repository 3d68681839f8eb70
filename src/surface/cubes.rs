//! Triangles of marching cubes (Lorensen and Cline 1987), derived for all 256 ways in which a cell's corners can lie.
//!
//! On a face whose corners lie crosswise, those inside are always parted. Both cells at the face then cut it alike, so that
//! meshes have no holes. No triangle has an edge across a face, so that no two cells have the same one and each edge of a mesh
//! has two triangles.

/// Numbers in a row of [`table`]: how many triangles, then one each, with four bits per edge.
pub const ROW: usize = 9;

/// An edge of the cell: 4 a + b runs along axis a; the bits of b say where along the axes a + 1 and a + 2.
type Edge = usize;

/// What shaders have as `cube_table`.
pub fn table() -> Vec<u32> {
    let mut table = vec![0; 256 * ROW];
    for (corners, row) in table.chunks_exact_mut(ROW).enumerate() {
        let triangles = triangles(corners);
        row[0] = triangles.len() as u32;
        for (packed, [a, b, c]) in row[1..].iter_mut().zip(triangles) {
            *packed = (a | b << 4 | c << 8) as u32;
        }
    }
    table
}

/// Triangles of a cell, bit c of `corners` says whether corner c is inside. They face outward.
fn triangles(corners: usize) -> Vec<[Edge; 3]> {
    let mut found = Vec::new();
    for polygon in polygons(corners) {
        let cut = triangulated(&polygon);
        found.extend(cut.expect("every polygon can be cut without an edge across a face"));
    }
    found
}

/// The edge between two corners that differ along one axis.
fn edge(from: usize, to: usize) -> Edge {
    let axis = (from ^ to).trailing_zeros() as usize;
    let along = |axis: usize| from >> (axis % 3) & 1;
    4 * axis + (along(axis + 1) | along(axis + 2) << 1)
}

/// The corners of the six faces, counterclockwise seen from outside.
fn faces() -> [[usize; 4]; 6] {
    let face = |axis: usize, upper: usize| {
        let [a, b] = [1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3)];
        let base = upper << axis;
        match upper {
            1 => [base, base + a, base + a + b, base + b],
            _ => [base, base + b, base + a + b, base + a],
        }
    };
    [(0, 0), (0, 1), (1, 0), (1, 1), (2, 0), (2, 1)].map(|(axis, upper)| face(axis, upper))
}

/// What the surface is in the cell, as loops of edges that it crosses.
fn polygons(corners: usize) -> Vec<Vec<Edge>> {
    let is_inside = |corner: usize| corners >> corner & 1 == 1;
    // From the edge where a face's outline comes into a run of corners inside to the one where it leaves it. The next face has
    // the same edge the other way round, so that these follow each other.
    let mut next = [None; 12];
    for face in faces() {
        for start in 0..4 {
            let at = |k: usize| face[(start + k) % 4];
            if is_inside(at(0)) || !is_inside(at(1)) {
                continue;
            }
            let length = (1..4).take_while(|&k| is_inside(at(k))).count();
            next[edge(at(0), at(1))] = Some(edge(at(length), at(length + 1)));
        }
    }
    let mut polygons = Vec::new();
    for first in 0..12 {
        let mut polygon = Vec::new();
        let mut here = first;
        while let Some(there) = next[here].take() {
            polygon.push(here);
            here = there;
        }
        if !polygon.is_empty() {
            polygons.push(polygon);
        }
    }
    polygons
}

/// Whether two edges of the cell lie on one face.
fn share_face(a: Edge, b: Edge) -> bool {
    let on = |edge: Edge, axis: usize, upper: usize| {
        let own = edge / 4;
        match (axis + 3 - own) % 3 {
            0 => false,
            1 => edge & 1 == upper,
            _ => edge >> 1 & 1 == upper,
        }
    };
    (0..6).any(|face| on(a, face / 2, face % 2) && on(b, face / 2, face % 2))
}

/// Triangles of a polygon that has no edge across a face.
fn triangulated(polygon: &[Edge]) -> Option<Vec<[Edge; 3]>> {
    let last = polygon.len() - 1;
    if last < 2 {
        return Some(Vec::new());
    }
    // The triangle at the edge from the last to the first, with each of the others as its third corner.
    (1..last).find_map(|third| {
        let is_fine = |from: usize, to: usize| to == from + 1 || !share_face(polygon[from], polygon[to]);
        if !is_fine(0, third) || !is_fine(third, last) {
            return None;
        }
        let mut triangles = triangulated(&polygon[..=third])?;
        triangles.push([polygon[0], polygon[third], polygon[last]]);
        triangles.extend(triangulated(&polygon[third..])?);
        Some(triangles)
    })
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use glam::Vec3;

    use super::*;

    /// The middle of an edge, in a cell from 0 to 1.
    fn middle(edge: Edge) -> Vec3 {
        let axis = edge / 4;
        let mut place = Vec3::ZERO;
        place[axis] = 0.5;
        place[(axis + 1) % 3] = (edge & 1) as f32;
        place[(axis + 2) % 3] = (edge >> 1 & 1) as f32;
        place
    }

    #[test]
    fn each_cut_of_a_cell_is_a_surface_around_its_corners() {
        for corners in 0..256 {
            let triangles = triangles(corners);
            assert!(triangles.len() < ROW);
            let mut halves = BTreeMap::new();
            for [a, b, c] in &triangles {
                for half in [(a, b), (b, c), (c, a)] {
                    *halves.entry(half).or_insert(0) += 1;
                }
            }
            for (&(a, b), &count) in &halves {
                assert_eq!(count, 1, "{corners}: {a} to {b}");
                // What ends at a face is gone on with by the cell beyond; inside of it each edge has two triangles.
                assert_ne!(
                    share_face(*a, *b),
                    halves.contains_key(&(b, a)),
                    "{corners}: {a} to {b}"
                );
            }
            // Each edge between a corner inside and one outside has a vertex.
            let crossed: Vec<Edge> = (0..12).filter(|e| halves.keys().any(|(a, _)| *a == e)).collect();
            let expected: Vec<Edge> = (0..8)
                .flat_map(|from| [1, 2, 4].map(|step| (from, from ^ step)))
                .filter(|(from, to)| from < to && (corners >> from ^ corners >> to) & 1 == 1)
                .map(|(from, to)| edge(from, to))
                .collect();
            assert_eq!(crossed.len(), expected.len(), "{corners}");
            assert!(expected.iter().all(|edge| crossed.contains(edge)), "{corners}");
        }
    }

    #[test]
    fn triangles_face_away_from_what_is_inside() {
        for corner in 0..8 {
            let [a, b, c] = triangles(1 << corner)[0].map(middle);
            let place = Vec3::new(
                (corner & 1) as f32,
                (corner >> 1 & 1) as f32,
                (corner >> 2) as f32,
            );
            assert!((b - a).cross(c - a).dot(a - place) > 0.0, "{corner}");
        }
    }
}
