//! Meshes with known volume and distance, for tests.

use std::f64::consts::TAU;

use glam::DVec3;

use super::Mesh;

/// Twelve triangles.
pub fn cube(min: DVec3, max: DVec3) -> Mesh {
    let vertices = (0..8)
        .map(|corner| {
            let pick = |axis: usize| if corner >> axis & 1 == 0 { min } else { max }[axis];
            DVec3::new(pick(0), pick(1), pick(2))
        })
        .collect();
    let quads = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    Mesh {
        vertices,
        triangles: quads.iter().flat_map(split).collect(),
    }
}

/// An octahedron whose triangles are split in four `levels` times, its vertices on the sphere.
pub fn ball(center: DVec3, radius: f64, levels: u32) -> Mesh {
    let [x, y, z] = DVec3::AXES;
    let mut faces: Vec<[DVec3; 3]> = Vec::new();
    for (a, b, c) in [(x, y, z), (y, x, -z), (z, y, -x), (x, z, -y)] {
        faces.push([a, b, c]);
        faces.push([-a, -c, -b]);
    }
    for _ in 0..levels {
        faces = faces
            .into_iter()
            .flat_map(|[a, b, c]| {
                let [ab, bc, ca] = [a + b, b + c, c + a].map(DVec3::normalize);
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    let vertices = faces
        .as_flattened()
        .iter()
        .map(|&direction| center + direction * radius)
        .collect();
    let triangles = (0..faces.len() as u32)
        .map(|face| [3 * face, 3 * face + 1, 3 * face + 2])
        .collect();
    Mesh { vertices, triangles }.welded()
}

/// Around the y axis: `major` from the axis to the middle of the tube, `minor` the tube's radius.
pub fn torus(major: f64, minor: f64, around: u32, across: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for i in 0..around {
        let (sin, cos) = (TAU * f64::from(i) / f64::from(around)).sin_cos();
        for j in 0..across {
            let (up, out) = (TAU * f64::from(j) / f64::from(across)).sin_cos();
            let distance = major + minor * out;
            mesh.vertices
                .push(DVec3::new(cos * distance, minor * up, sin * distance));
            let at = |i: u32, j: u32| (i % around) * across + j % across;
            mesh.triangles
                .extend(split(&[at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)]));
        }
    }
    mesh
}

fn split(&[a, b, c, d]: &[u32; 4]) -> [[u32; 3]; 2] {
    [[a, b, c], [a, c, d]]
}
