//! What cases of grains share.

use glam::DVec3;

use crate::scene::model::Integrator;
use crate::scene::{Grains, Scene};
use crate::simulation::frame::{Frame, Values};
use crate::study::accuracy::record::Method;

pub fn method(integrator: Integrator) -> Method {
    let integrator = serde_json::to_value(integrator).expect("a word");
    Method {
        solver: "dem".into(),
        integrator: integrator.as_str().unwrap_or_default().to_owned(),
        ..Default::default()
    }
}

/// # Panics
///
/// For a scene of fluid.
pub fn grains(scene: &Scene) -> &Grains {
    scene.grains().expect("a scene of grains")
}

/// ω0 of two grains in contact, rad/s: their spring and half a grain's mass.
pub fn frequency(scene: &Scene) -> f64 {
    let grains = grains(scene);
    (grains.contact.spring / (grains.mass / 2.0)).sqrt()
}

/// The scene with this time step (s) and so many steps a frame.
pub fn with_steps(mut scene: Scene, step: f64, a_frame: u32, frames: u32) -> Scene {
    scene.time.step = step;
    scene.time.steps_per_frame = a_frame;
    scene.time.fps = 1.0 / (step * f64::from(a_frame));
    scene.time.frames = frames;
    scene
}

/// A column of vectors in order of id; positions in the scene's own coordinates, z = 0 in 2D. Empty where the frame
/// has no such column.
pub fn vectors(frame: &Frame, name: &str) -> Vec<DVec3> {
    let Some(column) = frame.columns.iter().find(|column| column.name == name) else {
        return Vec::new();
    };
    let vector = |v: &[f64]| DVec3::new(v[0], v[1], v.get(2).copied().unwrap_or(0.0));
    match &column.values {
        Values::Double { columns, values } => values.chunks_exact(*columns).map(vector).collect(),
        Values::Vector { columns, values } => {
            let values: Vec<f64> = values.iter().map(|&v| v.into()).collect();
            values.chunks_exact(*columns).map(vector).collect()
        }
        Values::Float(_) | Values::Unsigned(_) => Vec::new(),
    }
}
