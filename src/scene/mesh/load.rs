//! Mesh files: OBJ, PLY and STL.

use std::io::{BufReader, Cursor};
use std::path::Path;

use glam::DVec3;

use super::Mesh;
use crate::files;
use crate::scene::ply;

pub fn load(path: &Path) -> Result<Mesh, String> {
    let name = path.display();
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    let (vertices, polygons) = match extension.to_ascii_lowercase().as_str() {
        "obj" => from_obj(path),
        "ply" => from_ply(path),
        "stl" => from_stl(path),
        _ => {
            return Err(format!(
                "{name}: meshes are read from .obj, .ply and .stl files; convert it to one of them"
            ));
        }
    }?;

    if let Some(index) = vertices.iter().position(|vertex| !vertex.is_finite()) {
        return Err(format!(
            "{name}: vertex {index} is at {}; repair the mesh so that every coordinate is a finite number",
            vertices[index]
        ));
    }
    let mut triangles = Vec::with_capacity(polygons.len());
    for (number, polygon) in polygons.iter().enumerate() {
        if let Some(index) = polygon
            .iter()
            .find(|&&index| usize::try_from(index).map_or(true, |index| index >= vertices.len()))
        {
            return Err(format!(
                "{name}: face {number} names vertex {index}, and there are {} (counted from 0); repair or re-export \
                 the mesh",
                vertices.len()
            ));
        }
        for pair in polygon.get(1..).unwrap_or_default().windows(2) {
            triangles.push([polygon[0], pair[0], pair[1]].map(|index| index as u32));
        }
    }
    let mesh = Mesh { vertices, triangles }.welded();
    if mesh.triangles.is_empty() {
        return Err(format!(
            "{name}: there are no faces with an area in it; export the mesh with its triangles, not only its points"
        ));
    }
    Ok(mesh.oriented())
}

/// Vertices, and polygons as indices counted from 0.
type Polygons = (Vec<DVec3>, Vec<Vec<i64>>);

fn from_obj(path: &Path) -> Result<Polygons, String> {
    let options = tobj::LoadOptions {
        triangulate: true,
        ignore_points: true,
        ignore_lines: true,
        ..Default::default()
    };
    let name = path.display();
    let file = files::open(path).map_err(|error| format!("{name}: {error}"))?;
    // Materials are not needed, so no file that holds them is opened.
    let materials = |_: &Path| Err(tobj::LoadError::OpenFileFailed);
    let (models, _) = tobj::load_obj_buf(&mut BufReader::new(file), &options, materials)
        .map_err(|error| format!("{name} is not a readable OBJ file: {error}; export it again"))?;
    let mut vertices = Vec::new();
    let mut polygons = Vec::new();
    for tobj::Model { mesh, .. } in models {
        let first = vertices.len() as i64;
        let (positions, _) = mesh.positions.as_chunks::<3>();
        vertices.extend(positions.iter().map(|p| DVec3::from(p.map(f64::from))));
        let (corners, _) = mesh.indices.as_chunks::<3>();
        polygons.extend(
            corners
                .iter()
                .map(|triangle| triangle.map(|index| first + i64::from(index)).to_vec()),
        );
    }
    Ok((vertices, polygons))
}

fn from_ply(path: &Path) -> Result<Polygons, String> {
    let file = ply::read(path)?;
    let axis = |wanted: &str| {
        let column = file.vertices.iter().find(|(name, _)| name == wanted);
        column.map(|(_, values)| values).ok_or_else(|| {
            format!(
                "{}: vertices have no property {wanted}; export the mesh with x, y and z",
                path.display()
            )
        })
    };
    let coordinates = axis("x")?.iter().zip(axis("y")?).zip(axis("z")?);
    let vertices = coordinates.map(|((&x, &y), &z)| DVec3::new(x, y, z)).collect();
    Ok((vertices, file.faces))
}

fn from_stl(path: &Path) -> Result<Polygons, String> {
    let name = path.display();
    let mut bytes = files::read(path).map_err(|error| format!("{name}: {error}"))?;
    // Binary files may begin with "solid", and ASCII files may leave the name after it out; stl_io tells the two apart
    // by "solid " alone. Their size is certain: 80 bytes of header, a count, 50 bytes a triangle.
    let count = bytes
        .get(80..84)
        .map(|count| u32::from_le_bytes([count[0], count[1], count[2], count[3]]));
    let announced = count.map(|count| 84 + 50 * u64::from(count));
    if announced.is_some_and(|announced| bytes.len() as u64 == announced) {
        bytes[..80].fill(0);
    } else if bytes.starts_with(b"solid") {
        bytes.insert(5, b' ');
    } else if announced.is_some_and(|announced| announced > bytes.len() as u64) {
        return Err(format!(
            "{name} is cut off: it announces {} bytes and has {}; export it again",
            announced.unwrap_or_default(),
            bytes.len()
        ));
    }
    let mesh = stl_io::read_stl(&mut Cursor::new(bytes))
        .map_err(|error| format!("{name} is not a readable STL file: {error}; export it again"))?;
    let vertices = mesh
        .vertices
        .iter()
        .map(|vertex| DVec3::from(vertex.0.map(f64::from)))
        .collect();
    let polygons = mesh
        .faces
        .iter()
        .map(|face| face.vertices.map(|index| index as i64).to_vec())
        .collect();
    Ok((vertices, polygons))
}
