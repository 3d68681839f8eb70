//! Frames and the time step.

use super::fluid::Fluid;
use super::frame::Report;
use super::text::number;
use super::{Contact, StepLimits, Time, model};

const MOST_FRAMES: f64 = 1e6;
const MOST_STEPS_PER_FRAME: f64 = 1e8;
/// Coarser steps make contacts gain energy or miss each other.
const FEWEST_STEPS_PER_CONTACT: f64 = 20.0;
/// Largest share of a velocity that damping may take in one explicit step.
const LARGEST_DAMPED_SHARE: f64 = 0.5;
/// Share of its radius that a grain may move in an adaptive step, by its speed or by its acceleration.
const GRAIN_SHARE: f64 = 0.1;

/// Frames f = 0, 1, … show time f / fps.
pub fn frames(time: &model::Time, report: &mut Report) -> u32 {
    let frames = (time.duration * time.fps).round() + 1.0;
    if frames > MOST_FRAMES {
        report.problem(
            "time",
            format!("duration × fps makes {} frames", number(frames)),
            format!(
                "make at most {}: shorten `duration` or lower `fps`",
                number(MOST_FRAMES)
            ),
        );
    }
    frames.min(MOST_FRAMES) as u32
}

/// When the last frame is, seconds.
pub fn end(time: &model::Time) -> f64 {
    f64::from(frames(time, &mut Report::default()) - 1) / time.fps
}

/// The step that resolves each of `contacts` (those that hold at any time of the run) and fits frames. `mass` is that of the
/// largest grain, kilograms; `radius` that of the smallest, metres.
pub fn of_grains(
    time: &model::Time,
    frames: u32,
    contacts: &[Contact],
    mass: f64,
    radius: f64,
    report: &mut Report,
) -> Time {
    let shortest = contacts
        .iter()
        .map(|contact| contact.duration(mass))
        .fold(f64::INFINITY, f64::min);
    let softer = match &contacts[0].friction {
        Some(friction) if friction.law == model::ContactLaw::Hertz => "lower grains.young_modulus",
        _ => "make grains.spring softer",
    };
    let coarsest = shortest / FEWEST_STEPS_PER_CONTACT;
    let usual = shortest / f64::from(time.steps_per_contact);
    let (mut step, mut limited_by) = match time.step {
        Some(step) if !time.adaptive || step < usual => (step, "scene's step"),
        _ => (usual, "contact duration"),
    };
    if step > coarsest * (1.0 + 1e-9) {
        report.problem(
            "time.step",
            format!(
                "{} s is too long: the shortest contact lasts {} s and needs {FEWEST_STEPS_PER_CONTACT} steps",
                number(step),
                number(shortest)
            ),
            format!("set it to at most {} s, leave it out, or {softer}", number(coarsest)),
        );
    }
    let rate = contacts
        .iter()
        .map(|contact| contact.damping_rate(mass))
        .fold(0.0, f64::max);
    if step * rate > LARGEST_DAMPED_SHARE {
        step = LARGEST_DAMPED_SHARE / rate;
        limited_by = "damping";
        if time.step.is_some() {
            report.notes.push(format!(
                "time.step was shortened to {} s, because damping is strong",
                number(step)
            ));
        }
    }
    let help = match contacts[0].friction {
        Some(_) => format!("raise `fps`, or {softer}"),
        None => "raise `fps`, make grains.spring softer, or lower grains.damping and grains.shear".into(),
    };
    let adaptive = time.adaptive.then_some(StepLimits {
        expected: step,
        constant: (step, limited_by),
        courant_distance: GRAIN_SHARE * radius,
        fall: GRAIN_SHARE * radius,
        sound_speed: 0.0,
        expected_speed: 0.0,
    });
    Time {
        contact_duration: Some(shortest),
        adaptive,
        integrator: match contacts[0].friction {
            Some(_) => model::Integrator::VelocityVerlet,
            None => time.integrator(),
        },
        ..fit_frames(time, frames, step, limited_by, &help, report)
    }
}

/// The step that sound, viscosity and weight of a fluid allow, and fits frames. `fluids` are the fluid as it is at the
/// start and after each change.
pub fn of_fluid(
    time: &model::Time,
    frames: u32,
    fluids: &[Fluid],
    gravity: f64,
    report: &mut Report,
) -> Time {
    // Steps of an incompressible fluid follow its motion; there is no sound that would limit them beforehand.
    let adaptive = time.adaptive || fluids[0].solver == model::FluidSolver::Dfsph;
    let (shortest, limit) = fluids
        .iter()
        .flat_map(|fluid| fluid.step_limits(gravity))
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .expect("there are four limits");
    let (step, limited_by) = match time.step {
        Some(step) if !adaptive || step < shortest => (step, "scene's step"),
        _ => (shortest, limit),
    };
    if step > shortest * (1.0 + 1e-9) {
        report.notes.push(format!(
            "time.step {} s is longer than the {} s that the {limit} allows: the run may blow up",
            number(step),
            number(shortest)
        ));
    }
    let help = "raise `fps`, lower fluid.sound_speed, or raise fluid.spacing";
    Time {
        adaptive: adaptive.then(|| {
            let each = fluids
                .iter()
                .map(|fluid| fluid.adaptive_limits(gravity, step, time.step));
            each.reduce(StepLimits::strictest).expect("a fluid")
        }),
        ..fit_frames(time, frames, step, limited_by, help, report)
    }
}

/// A whole number of steps no longer than `step` makes one frame.
fn fit_frames(
    time: &model::Time,
    frames: u32,
    step: f64,
    limited_by: &'static str,
    help: &str,
    report: &mut Report,
) -> Time {
    let frame = 1.0 / time.fps;
    let steps_per_frame = (frame / step * (1.0 - 1e-12)).ceil();
    if steps_per_frame > MOST_STEPS_PER_FRAME {
        report.problem(
            "time",
            format!(
                "a frame takes {} steps of {} s",
                number(steps_per_frame),
                number(step)
            ),
            help,
        );
    }
    Time {
        frames,
        fps: time.fps,
        step: frame / steps_per_frame,
        steps_per_frame: steps_per_frame as u32,
        integrator: time.integrator(),
        contact_duration: None,
        limited_by,
        adaptive: None,
    }
}
