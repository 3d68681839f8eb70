//! What the peer's fluid becomes: grains, since Sliceflow has no fluids. Everything that depends on it is here.

use glam::DVec3;
use serde_json::{Value, json};

use super::Files;
use super::convert::{coordinates, placement};
use super::keys::Ignored;
use super::peer::{Block, Model, Peer};
use crate::error::{Error, Result};
use crate::scene::mesh::Mesh;
use crate::scene::{Dimensions, particle_file};

/// Plain words for the user.
pub const NOTE: &str =
    "fluid particles become grains, which pile up instead of flowing: Sliceflow has no fluids yet";

/// Speed after over speed before a collision.
const RESTITUTION: f64 = 0.5;
/// How far grains at the fastest speed to expect press into a wall, as a share of their radius.
const OVERLAP: f64 = 0.15;
/// m/s, where nothing else gives a speed.
const SLOWEST: f64 = 1.0;

/// The scene's `grains`, for a domain of this height along gravity.
pub fn substance(peer: &Peer, height: f64, ignored: &mut Vec<Ignored>) -> Value {
    for (path, _) in &peer.time_step {
        ignored.push(Ignored::new(path, "a step of grains follows from their contacts"));
    }
    let material = peer.material();
    for other in &peer.materials {
        if material.is_none_or(|material| material.id != other.id) {
            ignored.push(Ignored::new(
                &other.path,
                "all grains are of the first fluid's material",
            ));
        }
    }
    let density = material.map_or(1000.0, |material| material.density);
    let speeds = peer
        .blocks
        .iter()
        .map(|b| b.velocity)
        .chain(peer.models.iter().map(|m| m.velocity));
    let fall = (2.0 * peer.gravity.length() * height).sqrt();
    let speed = speeds.map(DVec3::length).fold(fall, f64::max).max(SLOWEST);
    let mass = density
        * match peer.dimensions {
            2 => std::f64::consts::PI * peer.radius.powi(2),
            _ => 4.0 / 3.0 * std::f64::consts::PI * peer.radius.powi(3),
        };
    // m v² = k δ²
    let spring = mass * (speed / (OVERLAP * peer.radius)).powi(2);
    // Three digits say what is known.
    let digits = 10f64.powf(spring.log10().floor() - 2.0);
    json!({
        "radius": peer.radius,
        "density": density,
        "spring": (spring / digits).round() * digits,
        "restitution": RESTITUTION,
    })
}

/// A block's body: the peer sets its particles a spacing inside the corners, `round(size / spacing) - 1` along each
/// axis. `None` where that leaves none.
pub fn block(peer: &Peer, block: &Block, ignored: &mut Vec<Ignored>) -> Option<Value> {
    let spacing = 2.0 * peer.radius;
    let steps = ((block.max - block.min) / spacing).round() - 1.0;
    let axes = peer.dimensions;
    if (0..axes).any(|axis| steps[axis] < 2.0) {
        ignored.push(Ignored::new(
            &block.path,
            "it is too small for particles, there as here",
        ));
        return None;
    }
    if block.dense_mode != 0.0 {
        let path = format!("{}.denseMode", block.path);
        ignored.push(Ignored::new(path, "its particles stand on a plain lattice"));
    }
    let min = block.min + DVec3::splat(spacing - peer.radius);
    // A little more, so that rounding takes no layer away.
    let max = min + (steps + 1e-6) * spacing;
    let shape = json!({ "kind": "box", "min": coordinates(min, axes), "max": coordinates(max, axes) });
    Some(body(shape, block.velocity, axes))
}

/// Where a model's particles or its mesh are.
pub fn bounds(peer: &Peer, model: &Model, files: &Files) -> Result<(DVec3, DVec3)> {
    let path = files.find(&model.file);
    let dimensions = if peer.dimensions == 2 {
        Dimensions::Two
    } else {
        Dimensions::Three
    };
    let points = if is_mesh(model) {
        Mesh::load(&path).map(|mesh| mesh.vertices)
    } else {
        particle_file::load(&path, dimensions).map(|particles| particles.position)
    };
    let points = points
        .map_err(|what| Error::usage(format!("{}: {what}", model.path), "check that file, and its path"))?;
    let placed = Mesh {
        vertices: points
            .into_iter()
            .map(|point| model.transform.apply(point))
            .collect(),
        triangles: Vec::new(),
    };
    Ok(placed.bounds())
}

/// As the peer tells the two apart.
fn is_mesh(model: &Model) -> bool {
    let ending = model.file.rsplit('.').next().unwrap_or_default().to_lowercase();
    ["obj", "ply"].contains(&ending.as_str())
}

/// A model's body: a mesh to fill, or particles.
pub fn model(peer: &Peer, model: &Model, files: &Files, ignored: &mut Vec<Ignored>) -> Result<Option<Value>> {
    let is_mesh = is_mesh(model);
    if is_mesh && peer.dimensions == 2 {
        ignored.push(Ignored::new(&model.path, "a mesh has no place in a 2D scene"));
        return Ok(None);
    }
    let shape = json!({
        "kind": if is_mesh { "mesh" } else { "particles" },
        "file": files.name(&model.file)?,
        "placement": placement(&model.transform, peer.dimensions),
    });
    Ok(Some(body(shape, model.velocity, peer.dimensions)))
}

fn body(shape: Value, velocity: DVec3, axes: usize) -> Value {
    let mut body = json!({ "shape": shape });
    if velocity != DVec3::ZERO {
        body["velocity"] = coordinates(velocity, axes);
    }
    body
}
