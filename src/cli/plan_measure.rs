//! What `sliceflow plan --measure` adds to a plan.

use std::fmt;

use crate::error::Result;
use crate::gpu::AdapterChoice;
use crate::output::text::{count, seconds, short};
use crate::output::{Measured, Outputs, measure};
use crate::scene::Scene;

/// A burst of a scene's own steps, and the time of the run that follows from it.
pub struct Estimate {
    pub measured: Option<Measured>,
    frames: u32,
    /// Whether more particles come later.
    grows: bool,
    pictures: Option<[u32; 2]>,
    /// Outputs that are not counted.
    left_out: Vec<&'static str>,
}

impl Estimate {
    pub fn new(scene: &Scene, outputs: &Outputs, adapter: &AdapterChoice) -> Result<Self> {
        let left_out = [
            ("particle files", outputs.particles.is_some()),
            ("the video", outputs.video.is_some()),
            ("recordings", outputs.rerun.is_some()),
        ];
        Ok(Self {
            measured: measure(scene, outputs, adapter)?,
            frames: scene.time.frames,
            grows: !scene.schedule.is_empty(),
            pictures: outputs.pictures.then_some(scene.render.size),
            left_out: left_out
                .into_iter()
                .filter_map(|(name, is_wanted)| is_wanted.then_some(name))
                .collect(),
        })
    }
}

impl fmt::Display for Estimate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(measured) = &self.measured else {
            return writeln!(
                f,
                "measured   nothing: no particle appears in the first seconds of computing"
            );
        };
        writeln!(
            f,
            "measured   {} steps of {} particles: {} a step, {} particle steps/s",
            count(measured.steps),
            count(measured.particles.into()),
            milliseconds(measured.step_s),
            short(measured.particle_steps_per_s)
        )?;
        writeln!(
            f,
            "run time   about {}: {} to set up, {} for steps, {} for {} frames",
            seconds(measured.run_s),
            seconds(measured.setup_s),
            seconds(measured.steps_s),
            seconds(measured.frames_s + measured.pictures_s),
            count(self.frames.into()),
        )?;
        match self.pictures {
            Some([width, height]) => write!(f, "           assumed: pictures of {width}×{height}")?,
            None => write!(f, "           assumed: no pictures")?,
        }
        if self.grows {
            write!(f, ", particles as the scene adds them")?;
        }
        write!(f, ", nothing else computing meanwhile")?;
        if !self.left_out.is_empty() {
            write!(f, "; not counted: {}", self.left_out.join(", "))?;
        }
        writeln!(f)
    }
}

fn milliseconds(seconds: f64) -> String {
    format!("{:.3} ms", seconds * 1e3)
}
