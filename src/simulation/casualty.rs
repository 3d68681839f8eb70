//! Tells of a particle that the guard caught.

use glam::Vec3;

use super::Simulation;
use crate::error::{Casualty, Error};
use crate::physics::layout::{Guard, StepControl};
use crate::scene::field::contact_slots;

impl Simulation {
    /// The error that tells of a particle that the guard caught.
    pub(super) fn casualty(
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
        let speed = velocity.iter().map(|v| v * v).sum::<f32>().sqrt();
        let fault = &self.plan.model.fault;
        let radii = f64::from(speed) * place.step / self.scene.radius();
        let (what, likely_cause) = match guard.kind {
            Guard::RAN_AWAY if self.scene.fluid().is_some() => (
                "a particle is more than a hundred times faster than sound in the fluid",
                format!(
                    "pressures push it on without end, or the time step of {:.3e} s is too long; raise \
                     fluid.max_speed, lower time.step, or set fluid.negative_pressure to `clamp`",
                    place.step
                ),
            ),
            Guard::CROWDED => (
                "a grain touches more grains and walls than it can remember contacts",
                format!(
                    "there is room for {} of them, more than rigid grains can have: these overlap far too much; make \
                     them stiffer (grains.spring, or grains.young_modulus)",
                    contact_slots(self.scene.dimensions)
                ),
            ),
            Guard::NOT_FINITE | Guard::RAN_AWAY => (
                "a particle's position or velocity is not a finite number",
                format!(
                    "the time step of {:.3e} s is too long for {}",
                    place.step, fault.too_long_for
                ),
            ),
            _ => (
                "a particle left the domain through a closed side",
                format!(
                    "it moved {radii:.2} radii in a step of {:.3e} s, or was pressed through the wall; \
                     {}, lower time.step, or open that side",
                    place.step, fault.lost
                ),
            ),
        };
        Error::Guard(Box::new(Casualty {
            frame: place.frame,
            step: u64::from(guard.step),
            time: place.time,
            id: guard.id,
            position: position.to_array(),
            velocity,
            count: guard.count,
            what: what.into(),
            likely_cause,
        }))
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
                let since = step - first;
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
