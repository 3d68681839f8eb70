//! What the peer's fluid becomes: a fluid of the same particles.

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
pub fn note(peer: &Peer) -> &'static str {
    match solver(peer) {
        Solver::Dfsph => {
            "fluid becomes a fluid of the solver `dfsph` of the same spacing and density, with the viscosity of water: \
             coefficients of the peer's viscosity methods have no counterpart"
        }
        Solver::Wcsph => {
            "fluid becomes a weakly compressible fluid of the same spacing and density, with the viscosity of water and \
             some artificial viscosity: coefficients of the peer's viscosity methods have no counterpart"
        }
        Solver::WcsphForSeveral => {
            "fluids become weakly compressible ones of the same spacing and densities, with the viscosity of water and some \
             artificial viscosity: `dfsph` has one fluid only, and coefficients of the peer's viscosity methods have no \
             counterpart"
        }
    }
}

enum Solver {
    Dfsph,
    Wcsph,
    /// Where the peer's solver keeps several fluids incompressible.
    WcsphForSeveral,
}

fn solver(peer: &Peer) -> Solver {
    match (peer.is_incompressible, used(peer).len()) {
        (false, _) => Solver::Wcsph,
        (true, 0 | 1) => Solver::Dfsph,
        (true, _) => Solver::WcsphForSeveral,
    }
}

/// Of water, Pa·s.
const VISCOSITY: f64 = 1e-3;
/// Monaghan's α, which keeps impacts stable.
const ARTIFICIAL_VISCOSITY: f64 = 0.05;
/// kg/m³, where the peer's file gives none.
const DENSITY: f64 = 1000.0;

/// Ids of the materials that the fluid is of, each once.
fn used(peer: &Peer) -> Vec<&str> {
    let blocks = peer.blocks.iter().map(|block| block.material.as_str());
    let mut ids = Vec::new();
    for id in blocks.chain(peer.models.iter().map(|model| model.material.as_str())) {
        if !ids.contains(&id) {
            ids.push(id);
        }
    }
    ids
}

/// The scene's `fluid`.
pub fn substance(peer: &Peer, ignored: &mut Vec<Ignored>) -> Value {
    let is_dfsph = matches!(solver(peer), Solver::Dfsph);
    let why = match is_dfsph {
        true => "the step follows from the fluid's speed",
        false => "the step follows from the speed of sound",
    };
    for (path, _) in &peer.time_step {
        ignored.push(Ignored::new(path, why));
    }
    let used = used(peer);
    for material in &peer.materials {
        if !used.contains(&material.id.as_str()) {
            ignored.push(Ignored::new(&material.path, "no fluid is of it"));
        }
    }
    let density = |id: &str| {
        let found = peer.materials.iter().rfind(|material| material.id == id);
        found.map_or(DENSITY, |material| material.density)
    };
    let mut fluid = json!({
        "solver": if is_dfsph { "dfsph" } else { "wcsph" },
        "spacing": 2.0 * peer.radius,
        "density": used.first().map_or(DENSITY, |id| density(id)),
        "viscosity": VISCOSITY,
    });
    if is_dfsph {
        let errors = [
            ("max_density_error", peer.density_error),
            ("max_divergence_error", peer.divergence_error),
        ];
        for (key, error) in errors {
            if let Some(percent) = error {
                fluid[key] = (percent / 100.0).clamp(1e-6, 0.1).into();
            }
        }
    } else {
        fluid["artificial_viscosity"] = ARTIFICIAL_VISCOSITY.into();
    }
    if used.len() > 1 {
        let material = |id: &&str| json!({ "name": id, "density": density(id), "viscosity": VISCOSITY });
        fluid["materials"] = used.iter().map(material).collect();
    }
    fluid
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
    Some(body(peer, shape, &block.material, block.velocity))
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
    Ok(Some(body(peer, shape, &model.material, model.velocity)))
}

fn body(peer: &Peer, shape: Value, material: &str, velocity: DVec3) -> Value {
    let mut body = json!({ "shape": shape });
    if velocity != DVec3::ZERO {
        body["velocity"] = coordinates(velocity, peer.dimensions);
    }
    if used(peer).len() > 1 {
        body["material"] = material.into();
    }
    body
}
