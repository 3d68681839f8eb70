//! Mesh files that surfaces are written as.

use std::fmt::Write as _;

use super::{SurfaceMesh, VertexColumn, glb};

/// A format of meshes. To add one: a row of [`MESH_FORMATS`], and how its files begin in `src/output/folder.rs`.
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
        about: "binary, in single precision, with columns: Blender, MeshLab, Open3D",
        encode: ply,
    },
    MeshFormat {
        name: "obj",
        about: "text, in double precision, without columns",
        encode: obj,
    },
    MeshFormat {
        name: "glb",
        about: "binary glTF 2.0, with columns: Blender, three.js, Windows, macOS",
        encode: glb::encode,
    },
];

fn ply(mesh: &SurfaceMesh) -> Vec<u8> {
    let mut properties = vec!["x".to_owned(), "y".into(), "z".into()];
    if !mesh.normals.is_empty() {
        properties.extend(["nx", "ny", "nz"].map(String::from));
    }
    properties.extend(mesh.columns.iter().flat_map(column_names));
    let properties: String = properties
        .iter()
        .map(|name| format!("property float {name}\n"))
        .collect();
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\ncomment Sliceflow\nelement vertex {}\n{properties}element face {}\n\
         property list uchar int vertex_indices\nend_header\n",
        mesh.vertices.len(),
        mesh.triangles.len()
    )
    .into_bytes();
    for (i, vertex) in mesh.vertices.iter().enumerate() {
        let place = vertex.as_vec3().to_array().into_iter();
        let normal = mesh.normals.get(i).into_iter().flatten().copied();
        let values = mesh.columns.iter().flat_map(|column| column.row(i)).copied();
        bytes.extend(place.chain(normal).chain(values).flat_map(f32::to_le_bytes));
    }
    for triangle in &mesh.triangles {
        bytes.push(3);
        bytes.extend(triangle.iter().flat_map(|index| index.to_le_bytes()));
    }
    bytes
}

/// Properties that a column becomes; a vector's components are named as those of particle files.
fn column_names(column: &VertexColumn) -> Vec<String> {
    if column.width == 1 {
        return vec![column.name.clone()];
    }
    let initial = column.name.chars().next().unwrap_or_default();
    ["x", "y", "z"].map(|axis| format!("{initial}{axis}")).into()
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
