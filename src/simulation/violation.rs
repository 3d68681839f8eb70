//! What the device's guards caught, and where in the run.

use glam::Vec3;

use super::Simulation;
use crate::error::{Caught, Error, Violation};
use crate::guards::GuardKind;
use crate::physics::guard::edge;
use crate::physics::layout::{Guard, StepControl};
use crate::physics::step_control::names;
use crate::scene::field::contact_slots;

impl Simulation {
    /// The error for a particle that the guard caught. Frame `index` came after `steps` steps, the last of them at
    /// `step_control`.
    pub(super) fn caught(
        &self,
        guard: &Guard,
        index: u32,
        steps: u32,
        step_control: Option<&StepControl>,
    ) -> Error {
        let told = guard.told();
        let Some((accident, kind)) = told.and_then(|told| Some((told, GuardKind::of(told.kind)?))) else {
            return Error::device(
                "the guard counts accidents and tells of none",
                "this is a defect of the driver or of Sliceflow, please report it",
            );
        };
        let place = self.place_of(guard.step, index, steps, step_control);
        let [x, y, z, _] = accident.position;
        let [u, v, w, _] = accident.velocity;
        let speed = f64::from(Vec3::new(u, v, w).length());
        Error::Guard(Box::new(Violation {
            guard: kind,
            family: self.plan.model.family,
            detail: self.figures(kind, speed, place.step),
            frame: place.frame,
            step: u64::from(guard.step),
            time: place.time,
            step_s: place.step,
            step_limited_by: self.limit(step_control),
            particle: Some(Caught {
                id: accident.id,
                position: (Vec3::new(x, y, z).as_dvec3() + self.scene.origin).to_array(),
                velocity: [u, v, w],
                count: guard.count,
            }),
        }))
    }

    /// Figures for the cause of what happened to a particle at this speed, m/s, in a step of so many seconds.
    fn figures(&self, kind: GuardKind, speed: f64, step: f64) -> String {
        match kind {
            GuardKind::NotFinite => format!("the step had {step:.3e} s"),
            GuardKind::Edge => format!(
                "{:.1e} m away, numbers of single precision are a diameter apart",
                edge(&self.scene)
            ),
            GuardKind::Crowded => format!(
                "there is room for {} contacts, more than rigid grains usually have",
                contact_slots(&self.scene)
            ),
            _ => {
                // Of the smallest.
                let radii = speed * step * self.scene.size_ratio() / self.scene.radius();
                let than = match (self.scene.sound_speed(), self.scene.fluid()) {
                    (Some(sound), _) => format!("{:.3} times the speed of sound, ", speed / sound),
                    (None, Some(fluid)) => format!("{:.3} times fluid.max_speed, ", speed / fluid.max_speed),
                    (None, None) => String::new(),
                };
                format!("{speed:.3e} m/s, {than}{radii:.2} radii in a step of {step:.3e} s")
            }
        }
    }

    /// The error for steps that have become so short that a run would never end.
    pub(super) fn stalled(&self, step_control: &StepControl, steps: u32, expected: f64) -> Error {
        let limit = self.limit(Some(step_control));
        Error::Guard(Box::new(Violation {
            guard: GuardKind::StalledStep,
            family: self.plan.model.family,
            detail: format!(
                "a step would have {:.3e} s where {expected:.3e} s were expected, limited by the {limit}",
                step_control.wanted
            ),
            frame: self.next_frame,
            step: u64::from(steps),
            time: self
                .place_of(steps, self.next_frame, steps, Some(step_control))
                .time,
            step_s: f64::from(step_control.wanted),
            step_limited_by: limit,
            particle: None,
        }))
    }

    fn limit(&self, step_control: Option<&StepControl>) -> &'static str {
        let time = &self.scene.time;
        match time.adaptive.as_ref().zip(step_control) {
            Some((limits, control)) => names(limits)[(control.limit as usize).min(names(limits).len() - 1)],
            None => time.limited_by,
        }
    }

    /// Where in the run a step was. Frame `index` came after `steps` steps, the last of them at `step_control`.
    fn place_of(&self, step: u32, index: u32, steps: u32, step_control: Option<&StepControl>) -> Place {
        let time = self.scene.time;
        match step_control {
            // About: the steps of one interval differ in length.
            Some(step_control) => {
                let made = step_control.steps().max(1);
                let mean = 1.0 / (time.fps * f64::from(made));
                let since = (step + made).saturating_sub(steps);
                let before = f64::from(index.saturating_sub(1)) / time.fps;
                Place {
                    frame: index,
                    time: before + f64::from(since) * mean,
                    step: mean,
                }
            }
            None => {
                let (frame, first) = self.restored;
                let since = step.saturating_sub(first);
                Place {
                    frame: frame + since / time.steps_per_frame + 1,
                    time: f64::from(frame) / time.fps + f64::from(since) * time.step,
                    step: time.step,
                }
            }
        }
    }
}

/// When something happened.
struct Place {
    /// The first frame after it.
    frame: u32,
    /// Seconds.
    time: f64,
    /// Length of the steps there, seconds.
    step: f64,
}
