//! Mesh files that surfaces are written as.

use std::fmt::Write as _;

use super::SurfaceMesh;

/// A format of meshes. To add one: a row of [`MESH_FORMATS`].
#[derive(Debug)]
pub struct MeshFormat {
    /// On the command line, and the ending of a file's name.
    pub name: &'static str,
    pub about: &'static str,
    pub(super) encode: fn(&SurfaceMesh) -> Vec<u8>,
}

pub const MESH_FORMATS: &[MeshFormat] = &[
    MeshFormat {
        name: "ply",
        about: "binary, in single precision",
        encode: ply,
    },
    MeshFormat {
        name: "obj",
        about: "text, in double precision",
        encode: obj,
    },
];

fn ply(mesh: &SurfaceMesh) -> Vec<u8> {
    let normals = if mesh.normals.is_empty() {
        ""
    } else {
        "property float nx\nproperty float ny\nproperty float nz\n"
    };
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\ncomment Sliceflow\nelement vertex {}\nproperty float x\n\
         property float y\nproperty float z\n{normals}element face {}\nproperty list uchar int vertex_indices\n\
         end_header\n",
        mesh.vertices.len(),
        mesh.triangles.len()
    )
    .into_bytes();
    for (i, vertex) in mesh.vertices.iter().enumerate() {
        let normal = mesh.normals.get(i).into_iter().flatten().copied();
        bytes.extend(
            vertex
                .as_vec3()
                .to_array()
                .into_iter()
                .chain(normal)
                .flat_map(f32::to_le_bytes),
        );
    }
    for triangle in &mesh.triangles {
        bytes.push(3);
        bytes.extend(triangle.iter().flat_map(|index| index.to_le_bytes()));
    }
    bytes
}

fn obj(mesh: &SurfaceMesh) -> Vec<u8> {
    let mut text = String::from("# Sliceflow\n");
    let fits = "text grows as needed";
    for v in &mesh.vertices {
        writeln!(text, "v {} {} {}", v.x, v.y, v.z).expect(fits);
    }
    for [x, y, z] in &mesh.normals {
        writeln!(text, "vn {x} {y} {z}").expect(fits);
    }
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|index| index + 1);
        if mesh.normals.is_empty() {
            writeln!(text, "f {a} {b} {c}").expect(fits);
        } else {
            writeln!(text, "f {a}//{a} {b}//{b} {c}//{c}").expect(fits);
        }
    }
    text.into_bytes()
}
