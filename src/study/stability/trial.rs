//! A short run and what is seen of it.

use crate::error::{Error, Result};
use crate::output::{Guards, columns_named};
use crate::plan::Wanted;
use crate::scene::{Particles, Scene};
use crate::simulation::Simulation;
use crate::simulation::frame::{Frame, Statistics};
use crate::study::bench::{Bench, first_line, particles};

/// Figures of a frame; energies in joules, speeds in m/s.
pub struct Moment {
    pub time: f64,
    /// Of the steps before it, seconds; the mean where they are adaptive.
    pub step: f64,
    pub figures: Statistics,
}

impl Moment {
    pub fn energy(&self) -> f64 {
        self.figures.kinetic_energy + self.figures.potential_energy
    }
}

/// Why a run was no good.
pub enum Trouble {
    /// A guard stopped it, and said why: nobody takes its frames for good.
    Stopped(String),
    /// Nothing told.
    Wrong(String),
}

pub type Outcome<T = ()> = std::result::Result<T, Trouble>;

/// A run that came to its end.
pub struct Trial {
    pub moments: Vec<Moment>,
    /// At the end, in order of id.
    pub last: Particles,
}

/// Runs `frames` intervals of so many steps; why not, where the simulation gave up.
///
/// # Errors
///
/// What is wrong with the device, which tells nothing about the solver.
pub fn run(bench: &Bench, scene: &Scene, steps: u32, frames: u32) -> Result<Outcome<Trial>> {
    let mut scene = scene.with_steps_per_frame(steps);
    scene.time.frames = frames + 1;
    let wanted = Wanted {
        statistics: true,
        columns: columns_named(["position", "velocity"])?,
        ..Default::default()
    };
    match tried(bench.simulation(&scene, &wanted)?, &scene) {
        Ok(trial) if trial.moments.iter().any(|m| !m.energy().is_finite()) => {
            Ok(Err(Trouble::Wrong("energy is not finite".into())))
        }
        Err(error @ (Error::Device { .. } | Error::Shader { .. })) => Err(error),
        other => Ok(other.map_err(|error| match &error {
            Error::Guard(found) => {
                Trouble::Stopped(format!("`{}`: {}", found.guard.row().word, first_line(&error)))
            }
            _ => Trouble::Wrong(first_line(&error)),
        })),
    }
}

fn tried(mut simulation: Simulation, scene: &Scene) -> Result<Trial> {
    let mut trial = Trial {
        moments: Vec::new(),
        last: Particles::default(),
    };
    let mut guards = Guards::default();
    let mut take = |frame: Frame| {
        if let Some(found) = guards.check(scene, &frame) {
            return Err(Error::Guard(Box::new(found)));
        }
        trial.last = particles(scene.origin, &frame);
        if let Some(figures) = frame.statistics {
            trial.moments.push(Moment {
                time: frame.time,
                step: frame.step_s,
                figures,
            });
        }
        Ok(())
    };
    for _ in 0..scene.time.frames {
        if let Some(frame) = simulation.next_frame()? {
            take(frame)?;
        }
    }
    while let Some(frame) = simulation.finish_frame()? {
        take(frame)?;
    }
    Ok(trial)
}

/// How many particles lie farther than a spacing beyond the domain.
pub fn lost(scene: &Scene, particles: &Particles) -> usize {
    let room = 2.0 * scene.radius() as f32;
    let inside =
        |p: &&glam::Vec3| p.cmpge(scene.domain.min - room).all() && p.cmple(scene.domain.max + room).all();
    particles.len() - particles.position.iter().filter(inside).count()
}
