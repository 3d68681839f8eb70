//! Bounds of what the device's guards let particles do (`shaders/physics/guard.wgsl`).

use super::dem::bounds;
use super::layout::Guard;
use crate::scene::Scene;
use crate::scene::model::Wall;

/// Speed beyond which a fluid's particle has run away, in speeds of sound. Scenes may throw fluid faster than sound; what is
/// this fast is no flow, and soon no number.
pub const RUNAWAY: f64 = 100.0;
/// Beyond so many radii from the origin, numbers of single precision are a diameter apart.
const EDGE: f64 = 16_777_216.0;

/// How far away a particle may be, metres.
pub fn edge(scene: &Scene) -> f32 {
    (EDGE * scene.radius()) as f32
}

/// A guard that has seen nothing. Particles are lost a diameter beyond a side that is closed, and where single precision ends
/// beyond one that is open. They are too fast by the speed of sound in a fluid, and where steps have one length, by how far
/// they may move in one.
pub fn guard(scene: &Scene) -> Guard {
    let (mut lower, mut upper) = bounds(
        scene,
        |wall| !matches!(wall, Wall::Open | Wall::Periodic),
        -2.0 * scene.radius() as f32,
    );
    let edge = edge(scene);
    for axis in 0..3 {
        (lower[axis], upper[axis]) = (lower[axis].max(-edge), upper[axis].min(edge));
    }
    let by_sound = scene
        .fluid()
        .map_or(f64::INFINITY, |fluid| RUNAWAY * fluid.sound_speed);
    let by_step = match scene.time.adaptive {
        Some(_) => f64::INFINITY,
        None => scene.search_radius() / scene.size_ratio() / scene.time.step,
    };
    let square = |speed: f64| speed.powi(2).min(f32::MAX.into()) as f32;
    (lower[3], upper[3]) = (edge, square(by_sound.min(by_step)));
    Guard {
        lower,
        upper,
        runaway: square(by_sound),
        step: Guard::NO_STEP,
        lowest: u32::MAX,
        ..Guard::default()
    }
}
