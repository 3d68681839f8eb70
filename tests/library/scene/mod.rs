//! Scenes, made of what a user writes. Needs no GPU.

mod colors;
mod events;
mod files;
mod matter;
mod mistakes;
mod places;
mod times;

use std::f64::consts::PI;
use std::path::Path;

use serde_json::{Value, json};
use sliceflow::error::Error;
use sliceflow::scene::{Scene, load};

fn parse(scene: &Value, overrides: &[&str]) -> Result<Scene, Error> {
    let overrides: Vec<String> = overrides.iter().map(|one| one.to_string()).collect();
    load::parse(&scene.to_string(), "test.json", Path::new("tests"), &overrides)
}

fn valid(scene: &Value, overrides: &[&str]) -> Scene {
    parse(scene, overrides).unwrap_or_else(|error| panic!("{error}"))
}

fn message(scene: &Value, overrides: &[&str]) -> String {
    parse(scene, overrides)
        .expect_err("the scene should be refused")
        .to_string()
}

/// A 3D box of 2 m with a block of 4³ grains.
fn block() -> Value {
    json!({
        "domain": { "min": [-1, -1, -1], "max": [1, 1, 1] },
        "grains": { "radius": 0.05, "density": 1000, "spring": 1000, "restitution": 0.5 },
        "bodies": [{ "shape": { "kind": "box", "min": [0, 0, 0], "max": [0.4, 0.4, 0.4] }, "velocity": [1, 0, 0] }],
        "time": { "duration": 2, "fps": 10 }
    })
}

fn assert_near(value: f64, expected: f64) {
    assert!(
        (value - expected).abs() <= 1e-9 * expected.abs(),
        "{value} is not {expected}"
    );
}

// Contacts

/// Kilograms, of `block`'s grains.
fn ball_mass() -> f64 {
    1000.0 * 4.0 / 3.0 * PI * 0.05f64.powi(3)
}
