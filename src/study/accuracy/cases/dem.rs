//! What cases of grains share.

use crate::scene::model::Integrator;
use crate::scene::{Grains, Scene};
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

/// The scene with this time step (s) and so many steps per frame.
pub fn with_steps(mut scene: Scene, step: f64, a_frame: u32, frames: u32) -> Scene {
    scene.time.step = step;
    scene.time.steps_per_frame = a_frame;
    scene.time.fps = 1.0 / (step * f64::from(a_frame));
    scene.time.frames = frames;
    scene
}
