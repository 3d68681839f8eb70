//! Scenes of grains that rotate, and what their frames hold in f64.

use std::f64::consts::PI;
use std::path::Path;

use glam::DVec3;
use serde_json::{Value, json};
use sliceflow::error::Error;
use sliceflow::output::columns_named;
use sliceflow::plan::Wanted;
use sliceflow::scene::{Particles, Scene, load};
use sliceflow::simulation::{Frame, Values};

use crate::common;

#[allow(dead_code)]
pub const G: f64 = 9.81;

#[allow(dead_code)]
pub fn parse(file: &Value) -> Result<Scene, Error> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/common");
    load::parse(&file.to_string(), "test.json", &folder, &[])
}

/// The scene with these particles: position and velocity, in the scene's coordinates.
#[allow(dead_code)]
pub fn scene(file: &Value, particles: &[(DVec3, DVec3)]) -> Scene {
    let mut scene = parse(file).unwrap_or_else(|error| panic!("{error}"));
    scene.particles = Particles {
        position: particles.iter().map(|p| (p.0 - scene.origin).as_vec3()).collect(),
        velocity: particles.iter().map(|p| p.1.as_vec3()).collect(),
        ..Particles::default()
    };
    scene.capacity = particles.len() as u32;
    scene
}

/// Without gravity and walls, around zero; one particle somewhere, to be replaced.
#[allow(dead_code)]
pub fn empty(half: f64, grains: Value) -> Value {
    json!({
        "domain": { "min": [-half, -half, -half], "max": [half, half, half], "walls": "open" },
        "gravity": [0, 0, 0],
        "grains": grains,
        "bodies": [{ "shape": { "kind": "sphere", "center": [0, 0, 0], "radius": half / 2.0 } }],
        "time": { "duration": 1, "fps": 1 },
    })
}

/// On a floor at y = 0, with weight.
#[allow(dead_code)]
pub fn floor(half: f64, gravity: [f64; 3], grains: Value) -> Value {
    let mut file = empty(half, grains);
    file["domain"] = json!({
        "min": [-half, 0, -half], "max": [half, 2.0 * half, half], "walls": "open", "sides": { "y_min": "contact" }
    });
    file["gravity"] = json!(gravity);
    file["bodies"][0]["shape"]["center"] = json!([0, half, 0]);
    file
}

/// Frames of so many steps of this length.
#[allow(dead_code)]
pub fn stepped(mut scene: Scene, step: f64, a_frame: u32) -> Scene {
    scene.time.step = step;
    scene.time.steps_per_frame = a_frame;
    scene.time.fps = 1.0 / (step * f64::from(a_frame));
    scene
}

#[allow(dead_code)]
pub fn frames(scene: &Scene, last: u32) -> Vec<Frame> {
    let wanted = Wanted {
        statistics: true,
        columns: columns_named(["position", "velocity", "angular_velocity"]).expect("columns"),
        ..Default::default()
    };
    common::frames(&mut common::simulate(scene, &wanted), last)
}

#[allow(dead_code)]
pub fn vectors(frame: &Frame, name: &str) -> Vec<DVec3> {
    let column = frame.columns.iter().find(|c| c.name == name).expect("the column");
    let (width, values): (usize, Vec<f64>) = match &column.values {
        Values::Double { columns, values } => (*columns, values.clone()),
        Values::Vector { columns, values } => (*columns, values.iter().map(|&v| f64::from(v)).collect()),
        _ => panic!("{name} is no vector"),
    };
    let point = |v: &[f64]| DVec3::new(v[0], v[1], v.get(2).copied().unwrap_or(0.0));
    values.chunks_exact(width).map(point).collect()
}

#[allow(dead_code)]
pub fn mass(radius: f64, density: f64) -> f64 {
    density * 4.0 / 3.0 * PI * radius.powi(3)
}
