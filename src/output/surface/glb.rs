//! glTF 2.0 in one binary file (Khronos 2021, section 4.4): a mesh with normals, and columns as attributes of its own.

use glam::DVec3;
use serde_json::{Value, json};

use super::SurfaceMesh;

/// Numbers of the specification.
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const VERTICES: u32 = 34962;
const INDICES: u32 = 34963;

pub fn encode(mesh: &SurfaceMesh) -> Vec<u8> {
    // Numbers are in single precision, so that places count from the mesh's corner and the corner is the node's place.
    let corner = mesh
        .vertices
        .iter()
        .copied()
        .reduce(DVec3::min)
        .unwrap_or_default();
    let place: Vec<[f32; 3]> = mesh
        .vertices
        .iter()
        .map(|v| (*v - corner).as_vec3().to_array())
        .collect();
    let mut buffer = Buffer::default();
    let mut attributes = serde_json::Map::new();
    let index = buffer.floats(place.as_flattened(), 3);
    buffer.accessors[index]["min"] = json!(ends(&place, f32::min));
    buffer.accessors[index]["max"] = json!(ends(&place, f32::max));
    attributes.insert("POSITION".into(), index.into());
    if !mesh.normals.is_empty() {
        let index = buffer.floats(mesh.normals.as_flattened(), 3);
        attributes.insert("NORMAL".into(), index.into());
    }
    // Names of one's own begin with an underscore.
    for column in &mesh.columns {
        let index = buffer.floats(&column.values, column.width);
        attributes.insert(format!("_{}", column.name.to_ascii_uppercase()), index.into());
    }
    let corners = mesh.triangles.as_flattened();
    let indices = buffer.push(corners.iter().flat_map(|index| index.to_le_bytes()), INDICES);
    buffer.accessors.push(json!({
        "bufferView": indices, "componentType": UNSIGNED_INT, "count": corners.len(), "type": "SCALAR",
    }));
    let description = json!({
        "asset": { "generator": "Sliceflow", "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "name": "surface", "mesh": 0, "translation": corner.to_array() }],
        "meshes": [{
            "name": "surface",
            "primitives": [{ "attributes": attributes, "indices": buffer.accessors.len() - 1 }],
        }],
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{ "byteLength": buffer.bytes.len() }],
    });
    container(description.to_string().into_bytes(), buffer.bytes)
}

/// The file around both parts, each of whole words.
fn container(mut text: Vec<u8>, bytes: Vec<u8>) -> Vec<u8> {
    text.resize(text.len().next_multiple_of(4), b' ');
    let length = 12 + 8 + text.len() + 8 + bytes.len();
    let mut file = b"glTF".to_vec();
    file.extend([2, length as u32].map(u32::to_le_bytes).as_flattened());
    for (kind, part) in [(b"JSON", text), (b"BIN\0", bytes)] {
        file.extend((part.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(part);
    }
    file
}

fn ends(places: &[[f32; 3]], pick: fn(f32, f32) -> f32) -> [f32; 3] {
    [0, 1, 2].map(|axis| {
        places
            .iter()
            .map(|place| place[axis])
            .reduce(pick)
            .unwrap_or_default()
    })
}

#[derive(Default)]
struct Buffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Buffer {
    /// Adds a view of whole words; returns its number.
    fn push(&mut self, bytes: impl Iterator<Item = u8>, target: u32) -> usize {
        let begin = self.bytes.len();
        self.bytes.extend(bytes);
        self.views.push(json!({
            "buffer": 0, "byteOffset": begin, "byteLength": self.bytes.len() - begin, "target": target,
        }));
        self.views.len() - 1
    }

    /// Adds numbers or vectors of vertices; returns the number of the accessor.
    fn floats(&mut self, values: &[f32], width: usize) -> usize {
        let view = self.push(values.iter().flat_map(|value| value.to_le_bytes()), VERTICES);
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][width - 1];
        self.accessors.push(json!({
            "bufferView": view, "componentType": FLOAT, "count": values.len() / width, "type": kind,
        }));
        self.accessors.len() - 1
    }
}
