//! What the peer's fluid becomes: a fluid of the same particles.

use glam::DVec3;
use serde_json::{Value, json};

use super::Files;
use super::convert::{coordinates, placement};
use super::keys::Ignored;
use super::peer::{Block, Model, Peer, TimeStep, Viscosity};
use crate::error::{Error, Result};
use crate::scene::mesh::Mesh;
use crate::scene::{Dimensions, particle_file};

/// Plain words for the user.
pub fn note(peer: &Peer) -> String {
    let becomes = match solver(peer) {
        Solver::Dfsph => "fluid becomes a fluid of the solver `dfsph` of the same spacing and density",
        Solver::Wcsph => {
            "fluid becomes a weakly compressible fluid of the same spacing and density, with some artificial viscosity"
        }
        Solver::WcsphForSeveral => {
            "fluids become weakly compressible ones of the same spacing and densities, with some artificial viscosity: `dfsph` \
             has one fluid only"
        }
    };
    let viscosity = match used(peer)
        .iter()
        .all(|id| viscosity(peer, id) == Viscosity::Unknown)
    {
        true => "; its viscosity is that of water, since none is given",
        false => "",
    };
    format!("{becomes}{viscosity}")
}

/// Of a material by its id.
fn viscosity(peer: &Peer, id: &str) -> Viscosity {
    let found = peer.materials.iter().rfind(|material| material.id == id);
    found.map_or(Viscosity::Unknown, |material| material.viscosity)
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
/// Of the peer where its file gives none, seconds.
const LONGEST_STEP: f64 = 0.005;
/// kg/m³, where the peer's file gives none.
const DENSITY: f64 = 1000.0;

/// Ids of the materials that the fluid is of, each once.
fn used(peer: &Peer) -> Vec<&str> {
    let blocks = peer.blocks.iter().map(|block| block.material.as_str());
    let mut ids = Vec::new();
    let models = peer.models.iter().map(|model| model.material.as_str());
    let emitters = peer.emitters.iter().map(|emitter| emitter.material.as_str());
    for id in blocks.chain(models).chain(emitters) {
        if !ids.contains(&id) {
            ids.push(id);
        }
    }
    ids
}

/// Whether nothing of a scene says how fast its fluid will be.
fn is_at_rest(peer: &Peer) -> bool {
    let blocks = peer.blocks.iter().map(|block| block.velocity);
    let models = peer.models.iter().map(|model| model.velocity);
    peer.gravity == DVec3::ZERO && peer.emitters.is_empty() && blocks.chain(models).all(|v| v == DVec3::ZERO)
}

/// The scene's `emitters`, and the `events` that switch them before the run's `end`, seconds.
pub fn emitters(peer: &Peer, end: f64, ignored: &mut Vec<Ignored>) -> (Vec<Value>, Vec<Value>) {
    let (mut emitters, mut events) = (Vec::new(), Vec::new());
    for (k, emitter) in peer.emitters.iter().enumerate() {
        let name = format!("emitter_{k}");
        if !emitter.is_round {
            let why = "it is a rectangle there, and a disc of the same area here";
            ignored.push(Ignored::physics(format!("{}.type", emitter.path), why));
        }
        let mut own = json!({
            "name": name,
            "center": coordinates(emitter.center, peer.dimensions),
            "radius": emitter.radius,
            "velocity": coordinates(emitter.velocity, peer.dimensions),
        });
        if used(peer).len() > 1 {
            own["material"] = emitter.material.as_str().into();
        }
        if emitter.from > 0.0 {
            own["on"] = false.into();
        }
        emitters.push(own);
        let switches = [(emitter.from, true), (emitter.until, false)];
        for (at, on) in switches.into_iter().filter(|(at, _)| (1e-9..end).contains(at)) {
            events.push(json!({ "at": at, "emitter": { "name": name, "on": on } }));
        }
    }
    (emitters, events)
}

/// The scene's `fluid`.
pub fn substance(peer: &Peer, ignored: &mut Vec<Ignored>) -> Value {
    let is_dfsph = matches!(solver(peer), Solver::Dfsph);
    let TimeStep {
        size,
        method,
        factor,
        shortest,
        longest,
    } = &peer.time_step;
    let mut ignore = |keys: &[&Option<(String, f64)>], why: &str| {
        let given = keys.iter().copied().flatten();
        ignored.extend(given.map(|(path, _)| Ignored::new(path, why)));
    };
    if !is_dfsph {
        let why = "the step follows from the speed of sound";
        ignore(&[size, method, factor, shortest, longest], why);
    } else if peer.time_step.is_fixed() {
        ignore(&[shortest, longest], "steps are at most as long as timeStepSize");
        ignore(&[method, factor], "shorter steps follow the fluid's motion");
    } else {
        ignore(&[size, shortest], "the step follows from the fluid's motion");
    }
    if is_dfsph && used(peer).len() == 1 && peer.is_compressible {
        ignored.push(Ignored::physics(
            "Configuration.simulationMethod",
            "it is a compressible fluid there, and an incompressible one here",
        ));
    }
    if matches!(solver(peer), Solver::WcsphForSeveral) {
        ignored.push(Ignored::physics(
            "Configuration.simulationMethod",
            "several fluids are incompressible there, and weakly compressible here",
        ));
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
    let of_material = |id: &str| {
        let kinematic = match viscosity(peer, id) {
            Viscosity::Kinematic { fluid, .. } => fluid,
            Viscosity::None => 0.0,
            Viscosity::Unknown | Viscosity::Without => return VISCOSITY,
        };
        // So that no rounding is to be seen in the scene file.
        (kinematic * density(id) * 1e9).round() / 1e9
    };
    for material in &peer.materials {
        if material.viscosity == Viscosity::Without && used.contains(&material.id.as_str()) {
            let why = "its coefficient has no unit, so the fluid has the viscosity of water; set fluid.viscosity, Pa·s";
            ignored.push(Ignored::physics(
                format!("{}.viscosityMethod", material.path),
                why,
            ));
        }
    }
    let mut fluid = json!({
        "solver": if is_dfsph { "dfsph" } else { "wcsph" },
        "spacing": 2.0 * peer.radius,
        "density": used.first().map_or(DENSITY, |id| density(id)),
        "viscosity": used.first().map_or(VISCOSITY, |id| of_material(id)),
    });
    // There, walls resist by a coefficient of their own.
    let slips = |id: &&str| {
        matches!(
            viscosity(peer, id),
            Viscosity::Kinematic { boundary: 0.0, .. } | Viscosity::None
        )
    };
    if !used.is_empty() && used.iter().all(slips) {
        fluid["slip"] = "free_slip".into();
    }
    if is_at_rest(peer) {
        fluid["max_speed"] = (peer.time_step.courant_number() * 2.0 * peer.radius
            / peer.time_step.most().unwrap_or(LONGEST_STEP))
        .into();
    }
    if is_dfsph {
        if !peer.time_step.is_fixed() {
            fluid["courant_number"] = peer.time_step.courant_number().clamp(0.01, 1.0).into();
        }
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
        let material =
            |id: &&str| json!({ "name": id, "density": density(id), "viscosity": of_material(id) });
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
        ignored.push(Ignored::physics(path, "its particles stand on a plain lattice"));
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
        ignored.push(Ignored::physics(&model.path, "a mesh has no place in a 2D scene"));
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
