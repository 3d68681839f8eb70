//! One timed run of a scene, whose frames a case looks at.

use std::time::Instant;

use super::record::{Figure, Method, Record};
use crate::error::{Error, Result};
use crate::output::columns_named;
use crate::plan::Wanted;
use crate::scene::Scene;
use crate::simulation::frame::Frame;
use crate::study::bench::Bench;

/// What a run took.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Run {
    /// Particles at the end.
    pub particles: u32,
    /// Time step at the end, s.
    pub time_step: f64,
    pub steps: u64,
    /// s.
    pub simulated: f64,
    /// Wall time of all steps, s. The frame after the initial state, in which shaders compile, is not timed but
    /// counted as if its steps were as fast as the others'; where there is no other, it is timed.
    pub wall: f64,
    pub particle_updates: u64,
    /// Why it broke off.
    pub diverged: Option<String>,
}

/// Runs a scene and hands each frame, the initial state first, to `each`. A run that the guard stops has diverged; what
/// it had shown before counts.
pub fn run(bench: &Bench, scene: &Scene, columns: &[&str], mut each: impl FnMut(&Frame)) -> Result<Run> {
    let wanted = Wanted {
        columns: columns_named(columns.iter().copied())?,
        ..Default::default()
    };
    let mut simulation = bench.simulation(scene, &wanted)?;
    let mut run = Run::default();
    let mut timed_steps = 0;
    let mut start = Instant::now();
    for index in 0..scene.time.frames {
        let mut frames = Vec::new();
        let mut advance = || -> Result<()> {
            frames.extend(simulation.next_frame()?);
            // What shaders compile for is over when the first frames are here; the last ones are waited for.
            if index <= 1 || index + 1 == scene.time.frames {
                while let Some(frame) = simulation.finish_frame()? {
                    frames.push(frame);
                }
            }
            Ok(())
        };
        let outcome = advance();
        for frame in &frames {
            run.particle_updates += (frame.steps - run.steps) * u64::from(frame.particles);
            run.particles = frame.particles;
            run.time_step = frame.step_s;
            run.steps = frame.steps;
            run.simulated = frame.time;
            each(frame);
        }
        match outcome {
            Ok(()) => {}
            Err(error @ Error::Guard(_)) => {
                run.diverged = Some(error.to_string().lines().next().unwrap_or_default().to_owned());
                break;
            }
            Err(error) => return Err(error),
        }
        if index == 0 || (index == 1 && scene.time.frames > 2) {
            timed_steps = run.steps;
            start = Instant::now();
        }
    }
    let timed = run.steps - timed_steps;
    let share = if timed > 0 {
        run.steps as f64 / timed as f64
    } else {
        1.0
    };
    run.wall = start.elapsed().as_secs_f64() * share;
    Ok(run)
}

impl Run {
    /// This run and another one of the same kind as one, for cases that need several.
    pub fn with(self, other: Self) -> Self {
        Self {
            particles: self.particles.max(other.particles),
            time_step: other.time_step,
            steps: self.steps + other.steps,
            simulated: self.simulated + other.simulated,
            wall: self.wall + other.wall,
            particle_updates: self.particle_updates + other.particle_updates,
            diverged: self.diverged.or(other.diverged),
        }
    }

    /// The record of this run.
    pub fn record(
        self,
        bench: &Bench,
        case: &str,
        method: Method,
        resolution: u32,
        spacing: f64,
        figures: Vec<Figure>,
    ) -> Record {
        Record {
            case: case.into(),
            method,
            resolution,
            particles: self.particles,
            spacing,
            time_step: self.time_step,
            steps: self.steps,
            simulated: self.simulated,
            wall: self.wall,
            particle_updates: self.particle_updates,
            adapter: bench.adapter(),
            figures,
            diverged: self.diverged,
        }
    }
}
