//! Pairs of grains collide head-on with a linear spring and dashpot.

use glam::Vec3;

use super::Case;
use crate::error::Result;
use crate::scene::model::Integrator;
use crate::scene::{Particles, Scene};
use crate::study::Size;
use crate::study::accuracy::cases::columns::vectors;
use crate::study::accuracy::cases::dem::{frequency, method, with_steps};
use crate::study::accuracy::norms::Norms;
use crate::study::accuracy::published;
use crate::study::accuracy::record::{Bar, Figure, Record};
use crate::study::accuracy::run::{Run, run};
use crate::study::accuracy::theory::collision::Collision;
use crate::study::bench::Bench;
use crate::study::scenes;

pub const CASE: Case = Case {
    name: "collision",
    title: "Linear spring-dashpot collision",
    about: "Two grains meet head-on, and the contact ends at zero overlap, where the closed form of a damped oscillator \
            gives back e times the speed. Sixteen pairs touch at sixteen different parts of a step; e is 0.1, 0.3, 0.5, \
            0.7, 0.9 and 1. The figure is the largest difference from e of all.",
    resolution: "steps per contact",
    label: |steps| steps.to_string(),
    resolutions: |size| match size {
        Size::Tiny => &[20, 50],
        Size::Small | Size::Full => &[20, 50, 100, 200, 500, 1000],
    },
    figure: FIGURE,
    published: published::COLLISION,
    run: both_integrators,
};

const FIGURE: &str = "worst error of e";
/// The bar is set for this many steps per contact.
const JUDGED: u32 = 50;
const BAR: f64 = 1e-3;
const RESTITUTIONS: [f64; 6] = [0.1, 0.3, 0.5, 0.7, 0.9, 1.0];
/// Pairs stand on a square of so many rows and columns.
const ROWS: u32 = 4;
const PAIRS: u32 = ROWS * ROWS;
/// Of each grain, m/s.
const SPEED: f64 = 0.5;
/// Steps before the first pair touches.
const APPROACH: f64 = 2.0;
/// Frames of a run.
const FRAMES: u32 = 8;

fn both_integrators(bench: &Bench, _: Size, steps: u32) -> Result<Vec<Record>> {
    let integrators = [Integrator::SymplecticEuler, Integrator::VelocityVerlet];
    integrators
        .into_iter()
        .map(|integrator| record(bench, integrator, steps))
        .collect()
}

fn record(bench: &Bench, integrator: Integrator, steps: u32) -> Result<Record> {
    let mut whole = Run::default();
    let mut errors = Vec::new();
    for restitution in RESTITUTIONS {
        let scene = pairs(integrator, restitution, steps)?;
        let mut after = Vec::new();
        let run = run(bench, &scene, &["velocity"], |frame| {
            after = vectors(frame, "velocity")
        })?;
        let found = after
            .chunks_exact(2)
            .map(|pair| (pair[1].x - pair[0].x) / (2.0 * SPEED));
        let error = Norms::new(found.map(|found| (found, restitution))).largest;
        errors.push(Figure::new(
            format!("error of e = {restitution}"),
            run.diverged.is_none().then_some(error),
            "",
        ));
        whole = whole.with(run);
    }
    let worst = errors.iter().map(|figure| figure.value);
    let worst = worst.reduce(|a, b| Some(a?.max(b?))).flatten();
    let mut figure = Figure::new(FIGURE, worst, "").bar((steps == JUDGED).then_some(Bar::AtMost(BAR)));
    if let Some(best) = published::COLLISION[0].error_at(steps) {
        figure = figure.best(best, published::COLLISION[0].method);
    }
    let figures = [vec![figure], errors].concat();
    let spacing = 2.0 * scenes::RADIUS;
    Ok(whole.record(bench, CASE.name, method(integrator), steps, spacing, figures))
}

/// Pairs that touch between steps, each at another part of a step, and have parted when the scene ends.
fn pairs(integrator: Integrator, restitution: f64, steps: u32) -> Result<Scene> {
    let mut file = scenes::base("collision", [4 * ROWS; 3]);
    file["gravity"] = serde_json::json!([0, 0, 0]);
    file["grains"]["restitution"] = restitution.into();
    file["grains"]["shear"] = 0.into();
    let empty = scenes::with_particles(&file, Particles::default())?;
    let contact = Collision {
        restitution,
        frequency: frequency(&empty),
        speed: 2.0 * SPEED,
    };
    let step = contact.duration() / f64::from(steps);
    let middle = (empty.domain.min + empty.domain.max) / 2.0;
    let mut particles = Particles::default();
    for pair in 0..PAIRS {
        let part = f64::from(pair) / f64::from(PAIRS);
        let gap = contact.speed * step * (APPROACH + part);
        let place = |index: u32| (index as f32 - (ROWS - 1) as f32 / 2.0) * 8.0 * scenes::RADIUS as f32;
        let center = middle + Vec3::new(0.0, place(pair / ROWS), place(pair % ROWS));
        let half = Vec3::X * (scenes::RADIUS + gap / 2.0) as f32;
        particles.position.extend([center - half, center + half]);
        particles
            .velocity
            .extend([Vec3::X, Vec3::NEG_X].map(|v| v * SPEED as f32));
    }
    let mut scene = scenes::replaced(&empty, particles);
    scene.time.integrator = integrator;
    // Some steps more than the contact, and a whole number a frame.
    let all = f64::from(steps) + APPROACH + 4.0;
    let a_frame = (all / f64::from(FRAMES - 1)).ceil() as u32;
    Ok(with_steps(scene, step, a_frame, FRAMES))
}
