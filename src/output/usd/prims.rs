//! A frame's particles as `Points` and its surface as `Mesh`, in the scene's local coordinates.

use glam::DVec3;

use super::layer::{Layer, identifier, numbers, vectors};
use crate::output::read_back::Snapshot;
use crate::scene::Scene;
use crate::scene::ply::PlyFile;

/// Names of vertices' columns in PLY files that are no columns of particles.
const PLACES: [&str; 9] = ["x", "y", "z", "nx", "ny", "nz", "vx", "vy", "vz"];

pub fn points(scene: &Scene, snapshot: &Snapshot) -> Result<Layer, String> {
    let mut layer = Layer::default();
    let position = snapshot.column("position").filter(|column| column.width == 3);
    let position = position.ok_or("it has no positions in space")?;
    let place: Vec<_> = position
        .values
        .chunks_exact(3)
        .map(|p| DVec3::from_slice(p) - scene.origin)
        .collect();
    let radius = scene.radius();
    put_places(&mut layer, &place, radius);
    match scene.has_field("radius") {
        true => {
            let column = snapshot
                .column("radius")
                .ok_or("it does not tell how large its grains are")?;
            layer.put(
                "float[] widths",
                "interpolation = \"vertex\"",
                numbers(column.values.iter().map(|&radius| finite(2.0 * radius))),
            );
        }
        false => layer.put(
            "float[] widths",
            "interpolation = \"constant\"",
            numbers([2.0 * radius as f32]),
        ),
    }
    for column in &snapshot.columns {
        let name = column.name.as_str();
        let values = column.values.iter().map(|&value| finite(value));
        match (name, column.width) {
            ("position", _) => {}
            ("velocity", 3) => layer.put("vector3f[] velocities", "", triples(values)),
            ("id", 1) => layer.put(
                "int64[] ids",
                "",
                numbers(column.values.iter().map(|&id| id as i64)),
            ),
            (name, 1) => put_column(&mut layer, name, values),
            (name, 3) => layer.put(
                format!("vector3f[] primvars:{}", identifier(name)),
                "interpolation = \"vertex\"",
                triples(values),
            ),
            _ => {}
        }
    }
    Ok(layer)
}

pub fn surface(scene: &Scene, file: &PlyFile) -> Result<Layer, String> {
    let mut layer = Layer::default();
    let column = |name: &str| {
        file.vertices
            .iter()
            .find(|(known, _)| known == name)
            .map(|(_, values)| values)
    };
    let vector = |names: [&str; 3]| {
        let [Some(x), Some(y), Some(z)] = names.map(column) else {
            return None;
        };
        Some(x.iter().zip(y).zip(z).map(|((&x, &y), &z)| DVec3::new(x, y, z)))
    };
    let place = vector(["x", "y", "z"]).ok_or("it has no x, y and z")?;
    let place: Vec<_> = place.map(|p| p - scene.origin).collect();
    if file
        .faces
        .iter()
        .flatten()
        .any(|&index| usize::try_from(index).map_or(true, |i| i >= place.len()))
    {
        return Err("a face names a vertex that is not there".into());
    }
    put_places(&mut layer, &place, 0.0);
    layer.put(
        "int[] faceVertexCounts",
        "",
        numbers(file.faces.iter().map(Vec::len)),
    );
    layer.put(
        "int[] faceVertexIndices",
        "",
        numbers(file.faces.iter().flatten()),
    );
    let flat = |vector: DVec3| vector.to_array().map(finite);
    if let Some(normals) = vector(["nx", "ny", "nz"]) {
        layer.put(
            "normal3f[] normals",
            "interpolation = \"vertex\"",
            vectors(normals.map(flat)),
        );
    }
    if let Some(velocity) = vector(["vx", "vy", "vz"]) {
        layer.put("vector3f[] velocities", "", vectors(velocity.map(flat)));
    }
    for (name, values) in file
        .vertices
        .iter()
        .filter(|(name, _)| !PLACES.contains(&name.as_str()))
    {
        put_column(&mut layer, name, values.iter().map(|&value| finite(value)));
    }
    Ok(layer)
}

fn put_places(layer: &mut Layer, place: &[DVec3], radius: f64) {
    let sound = place.iter().filter(|p| p.is_finite());
    let (low, high) = sound.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| {
        (low.min(*p), high.max(*p))
    });
    let ends = if low.x <= high.x {
        [low - radius, high + radius]
    } else {
        [DVec3::ZERO; 2]
    };
    let single = |p: DVec3| p.to_array().map(finite);
    layer.put("float3[] extent", "", vectors(ends.map(single)));
    layer.put("point3f[] points", "", vectors(place.iter().copied().map(single)));
}

fn put_column(layer: &mut Layer, name: &str, values: impl Iterator<Item = f32>) {
    let declaration = format!("float[] primvars:{}", identifier(name));
    layer.put(declaration, "interpolation = \"vertex\"", numbers(values));
}

fn triples(values: impl Iterator<Item = f32>) -> String {
    let values: Vec<f32> = values.collect();
    vectors(values.chunks_exact(3).map(|v| [v[0], v[1], v[2]]))
}

/// USD's text has no word for what is not a number that all readers know; where a run went wrong, it is 0.
fn finite(value: f64) -> f32 {
    let single = value as f32;
    if single.is_finite() { single } else { 0.0 }
}
