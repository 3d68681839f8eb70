//! What a run has done so far, and how fast.

use std::time::Instant;

use schemars::JsonSchema;
use serde::Serialize;

use crate::simulation::frame::Frame;

/// How far a run has come, and how fast.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct Tally {
    /// Frames that were simulated and handed to the outputs.
    pub frames_done: u32,
    /// Frames of the whole run.
    pub frames: u32,
    /// Time that the run took, seconds; of a run that was resumed, all its parts together.
    pub wall_s: f64,
    /// Particles times steps.
    pub particle_steps: u64,
    /// Particles times steps, per second of `wall_s`.
    pub particle_steps_per_s: f64,
    /// Of earlier sittings.
    #[serde(skip)]
    wall_before_s: f64,
    #[serde(skip)]
    started: Instant,
    /// Of the last frame, since the run began.
    #[serde(skip)]
    steps: u64,
}

impl Tally {
    /// Starts the clock.
    pub fn start(frames: u32) -> Self {
        Self {
            frames_done: 0,
            frames,
            wall_s: 0.0,
            particle_steps: 0,
            particle_steps_per_s: 0.0,
            wall_before_s: 0.0,
            started: Instant::now(),
            steps: 0,
        }
    }

    /// Goes on with what earlier sittings did: `steps` since the run began, `particle_steps`, seconds.
    pub fn resume(mut self, frames_done: u32, steps: u64, particle_steps: u64, wall_s: f64) -> Self {
        self.frames_done = frames_done;
        self.steps = steps;
        self.particle_steps = particle_steps;
        self.wall_before_s = wall_s;
        self
    }

    /// Counts the next frame.
    pub fn add(&mut self, frame: &Frame) {
        self.frames_done += 1;
        self.particle_steps += (frame.steps - self.steps) * u64::from(frame.particles);
        self.steps = frame.steps;
        self.stop_clock();
        self.particle_steps_per_s = self.particle_steps as f64 / self.wall_s;
    }

    /// Counts the next frame of a run that is drawn again, in which no steps are made.
    pub fn add_drawn(&mut self) {
        self.frames_done += 1;
        self.stop_clock();
    }

    /// Reads the clock once more.
    pub fn stop_clock(&mut self) {
        self.wall_s = self.wall_before_s + self.started.elapsed().as_secs_f64();
    }
}
