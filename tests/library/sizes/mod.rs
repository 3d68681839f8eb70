//! Grains of several sizes: what tests of them share.

mod contacts;
mod places;

use glam::DVec3;
use serde_json::{Value, json};
use sliceflow::scene::{Particles, Scene};
use sliceflow::simulation::{Frame, Values};

use crate::rotating::parse;

const R: f64 = 0.01;

/// Between a quarter of R and R.
fn sized(mut grains: Value) -> Value {
    grains["radius"] = json!(R);
    grains["sizes"] = json!({ "kind": "uniform", "smallest": R / 4.0 });
    grains
}

/// A grain: center, velocity, radius.
type Grain = (DVec3, DVec3, f64);

fn radii_of(frame: &Frame) -> Vec<f32> {
    let column = frame.columns.iter().find(|c| c.name == "radius").unwrap();
    let Values::Float(radii) = &column.values else {
        panic!("radii are numbers")
    };
    radii.clone()
}

fn scene(file: &Value, grains: &[Grain]) -> Scene {
    let mut scene = parse(file).unwrap_or_else(|error| panic!("{error}"));
    scene.particles = Particles {
        position: grains.iter().map(|g| (g.0 - scene.origin).as_vec3()).collect(),
        velocity: grains.iter().map(|g| g.1.as_vec3()).collect(),
        radius: grains.iter().map(|g| g.2 as f32).collect(),
        ..Particles::default()
    };
    scene.capacity = grains.len() as u32;
    scene
}
