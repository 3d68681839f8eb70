//! What the device's guard caught, in words.

use glam::Vec3;

use super::Simulation;
use crate::error::{Caught, Error, Violation};
use crate::physics::dem::{RUNAWAY, edge};
use crate::physics::layout::{Guard, StepControl};
use crate::physics::step_control::names;
use crate::scene::field::contact_slots;

/// A guard's word, what it found, the likely cause, and what to change.
type Story = (&'static str, String, String, String);

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
        let place = self.place_of(guard.step, index, steps, step_control);
        let local = Vec3::new(guard.position[0], guard.position[1], guard.position[2]);
        let position = local.as_dvec3() + self.scene.origin;
        let velocity = [guard.velocity[0], guard.velocity[1], guard.velocity[2]];
        let speed = f64::from(velocity.iter().map(|v| v * v).sum::<f32>().sqrt());
        let (word, what, likely_cause, help) = match guard.kind {
            Guard::RAN_AWAY => self.ran_away(speed, place.step),
            Guard::CROWDED => self.crowded(),
            Guard::NOT_FINITE => self.not_finite(place.step),
            _ if local.abs().max_element() > 0.5 * edge(&self.scene) => self.beyond_the_edge(),
            _ => self.lost(speed, place.step),
        };
        Error::Guard(Box::new(Violation {
            guard: word,
            frame: place.frame,
            step: u64::from(guard.step),
            time: place.time,
            step_s: place.step,
            step_limited_by: self.limit(step_control),
            particle: Some(Caught {
                id: guard.id,
                position: position.to_array(),
                velocity,
                count: guard.count,
            }),
            what,
            likely_cause,
            help,
        }))
    }

    /// The error for steps that have become so short that a run would never end.
    pub(super) fn stalled(&self, step_control: &StepControl, steps: u32, expected: f64) -> Error {
        let limit = self.limit(Some(step_control));
        Error::Guard(Box::new(Violation {
            guard: "stalled_step",
            frame: self.next_frame,
            step: u64::from(steps),
            time: self.place_of(steps, self.next_frame, steps, Some(step_control)).time,
            step_s: f64::from(step_control.wanted),
            step_limited_by: limit,
            particle: None,
            what: "steps have become so short that the run would never end".into(),
            likely_cause: format!(
                "a step would have {:.3e} s where {expected:.3e} s were expected, limited by the {limit}: a particle is \
                 far too fast, or two lie in one another",
                step_control.wanted
            ),
            help: "look at the frame before for particles that are far too fast, begin with a scene whose particles do \
                   not lie in one another, or set time.adaptive to false"
                .into(),
        }))
    }

    fn ran_away(&self, speed: f64, step: f64) -> Story {
        let radii = speed * step * self.scene.size_ratio() / self.scene.radius();
        let Some(fluid) = self.scene.fluid() else {
            return (
                "too_fast",
                "a grain moves farther than its diameter in one step".into(),
                format!("it moved {radii:.2} radii in a step of {step:.3e} s, and would pass through others"),
                "lower time.step, or set time.adaptive".into(),
            );
        };
        let cause = "pressures push it on without end, or the time step is too long";
        let (what, help) = match self.scene.sound_speed() {
            Some(_) => (
                "a particle is more than a hundred times faster than sound in the fluid".to_owned(),
                "raise fluid.max_speed, lower time.step, or set fluid.negative_pressure to `clamp`",
            ),
            None => (
                format!(
                    "a particle is more than {:.0} times faster than fluid.max_speed",
                    RUNAWAY * fluid.sound_speed / fluid.max_speed
                ),
                "lower fluid.courant_number or time.step",
            ),
        };
        match speed > RUNAWAY * fluid.sound_speed {
            true => (
                "runaway",
                what,
                format!("{cause}; it has {step:.3e} s"),
                help.into(),
            ),
            false => (
                "too_fast",
                "a particle moves farther than its neighbors are in one step".into(),
                format!("{cause}: it moved {radii:.2} radii in a step of {step:.3e} s"),
                help.into(),
            ),
        }
    }

    fn crowded(&self) -> Story {
        let room = contact_slots(&self.scene);
        (
            "crowded",
            "a grain touches more grains and walls than it can remember contacts".into(),
            format!(
                "there is room for {room} of them, more than rigid grains usually have: these overlap far too much"
            ),
            "make them stiffer (grains.spring, or grains.young_modulus)".into(),
        )
    }

    fn not_finite(&self, step: f64) -> Story {
        let fault = &self.plan.model.fault;
        (
            "not_finite",
            "a particle's position or velocity is not a finite number".into(),
            format!(
                "the time step of {step:.3e} s is too long for {}",
                fault.too_long_for
            ),
            fault.shorter.into(),
        )
    }

    fn lost(&self, speed: f64, step: f64) -> Story {
        let radii = speed * step * self.scene.size_ratio() / self.scene.radius();
        (
            "lost",
            "a particle left the domain through a closed side".into(),
            format!("it moved {radii:.2} radii in a step of {step:.3e} s, or was pressed through the wall"),
            format!(
                "{}, lower time.step, or open that side",
                self.plan.model.fault.lost
            ),
        )
    }

    fn beyond_the_edge(&self) -> Story {
        (
            "edge",
            "a particle is so far away that its coordinates no longer resolve it".into(),
            format!(
                "it left through an open side and is {:.1e} m away, where numbers of single precision are a diameter apart",
                edge(&self.scene)
            ),
            "close that side, end the run earlier, or lower time.step if it was thrown out".into(),
        )
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
