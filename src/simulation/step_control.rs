//! Steps whose length the device chooses: what the host tells it, and what comes back.

use super::Simulation;
use super::frame::AdaptiveSteps;
use super::segments::Segment;
use crate::error::Result;
use crate::physics::collider::offset_at;
use crate::physics::layout::{Clock, Guard, StepControl};
use crate::physics::step_control::names;
use crate::scene::Scene;

/// What a run begins with.
pub(super) fn at_start(scene: &Scene) -> StepControl {
    let limits = scene.time.adaptive.as_ref();
    limits.map_or_else(StepControl::default, |limits| StepControl::new(limits, 0.0))
}

impl Simulation {
    /// Sets out for a segment's end.
    pub(super) fn step_segment(&mut self, segment: &Segment) -> Result<()> {
        let seconds = segment.end_time - segment.start_time;
        let speed = |path: &[_]| {
            let way = offset_at(path, segment.end_time) - offset_at(path, segment.start_time);
            way.length() / seconds as f32
        };
        let speeds = self.scene.colliders.iter().map(|collider| speed(&collider.path));
        let fastest = speeds.fold(0.0, f32::max);
        self.step_control
            .begin_segment(seconds, segment.ends_frame, fastest);
        self.write_step_control()
    }

    pub(super) fn write_step_control(&self) -> Result<()> {
        match self.scene.time.adaptive {
            Some(_) => self
                .buffers
                .write(&self.gpu, "step_control", 0, &[self.step_control]),
            None => Ok(()),
        }
    }

    /// Has the passes behind a search find densities and accelerations without any time passing, so that they leave
    /// velocities alone.
    pub(super) fn hold(&mut self) -> Result<()> {
        self.step_control.step = 0.0;
        self.write_step_control()?;
        self.write_parameters(0.0)
    }

    /// Gives up a run whose steps have become so short that it would never end.
    pub(super) fn refuse_to_stall(&self) -> Result<()> {
        let step_control = &self.step_control;
        let Some(limits) = self
            .scene
            .time
            .adaptive
            .as_ref()
            .filter(|_| step_control.stalled != 0)
        else {
            return Ok(());
        };
        let clock = self.read_one::<Clock>("clock")?;
        let guard = self.read_one::<Guard>("guard")?;
        if guard.count > 0 {
            return Err(self.caught(&guard, self.next_frame, clock.step, Some(step_control)));
        }
        Err(self.stalled(step_control, clock.step, limits.expected))
    }

    /// How the steps since the last frame were; `None` where there was none.
    pub(super) fn adaptive_steps(&self, step_control: Option<&StepControl>) -> Option<AdaptiveSteps> {
        let (limits, step_control) = self.scene.time.adaptive.as_ref().zip(step_control)?;
        let limited = names(limits).into_iter().zip(step_control.made);
        (step_control.steps() > 0).then(|| AdaptiveSteps {
            shortest_s: step_control.shortest.into(),
            longest_s: step_control.longest.into(),
            limited_by: limited.filter(|(_, made)| *made > 0).collect(),
        })
    }
}
