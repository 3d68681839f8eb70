//! `sliceflow bench`: a fixed set of scenes at growing sizes, and what the adapter could do at best beside them.

mod demand;
pub mod probes;
pub mod report;
pub mod scenes;

use std::path::Path;
use std::time::Instant;

use crate::error::{Error, Result};
use crate::gpu::device::Identity;
use crate::gpu::{AdapterChoice, Gpu};
use crate::output::text::{count, seconds};
use crate::output::{columns_named, compose_picture, encode_png, interrupt, now};
use crate::plan::{Plan, Wanted};
use crate::render::Overlay;
use crate::scene::Scene;
use crate::scene::model::View;
use crate::simulation::State;
use crate::simulation::frame::Frame;
use crate::study::bench::{Bench, first_line, pairs};
use crate::study::measure::Measured;
use demand::Rates;
use probes::Probes;
use report::{LeftOut, Machine, Outputs, PassTime, Report, Run, Spread};
use scenes::{SUBJECTS, Subject};

/// How much is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Size {
    /// Seconds; for tests.
    Tiny,
    /// A minute or two.
    Quick,
    /// At most ten minutes.
    Default,
    /// All sizes that fit the adapter, however long they take.
    Full,
}

/// What a benchmark is asked for.
pub struct Settings {
    pub size: Size,
    /// Names of the scenes to measure; all where there is none.
    pub scenes: Vec<String>,
    pub adapter: AdapterChoice,
    /// Whether nothing is told on the way.
    pub quiet: bool,
}

/// How a size is measured.
struct Scale {
    name: &'static str,
    particles: &'static [u32],
    /// s.
    limit: f64,
    /// Rounds, and how long each should take, s.
    rounds: u32,
    round: f64,
    probes: probes::Scale,
}

const HARDWARE: probes::Scale = probes::Scale {
    copied_bytes: 256 << 20,
    least_ms: 20.0,
};

impl Size {
    fn scale(self) -> Scale {
        const ALL: &[u32] = &[16_384, 65_536, 262_144, 1_048_576, 4_194_304];
        let scale = |name, particles, limit, round| Scale {
            name,
            particles,
            limit,
            rounds: 5,
            round,
            probes: HARDWARE,
        };
        match self {
            Self::Tiny => Scale {
                rounds: 2,
                probes: probes::Scale {
                    copied_bytes: 1 << 20,
                    least_ms: 1.0,
                },
                ..scale("tiny", &[500], f64::INFINITY, 0.0)
            },
            Self::Quick => scale("quick", &ALL[..1], 120.0, 0.5),
            Self::Default => scale("default", ALL, 600.0, 1.0),
            Self::Full => scale("full", ALL, f64::INFINITY, 2.0),
        }
    }
}

/// Steps of a frame; neighbor lists serve about as many.
const STEPS: u32 = 8;
/// Frames of a round at most, so that a scene is still itself at the end.
const MOST_FRAMES: u32 = 16;
/// Rounds of a size whose frames take longer than a round should, and how often passes are timed.
const FEWEST_ROUNDS: u32 = 3;
const TIMED: usize = 2;
/// What measuring takes at least, in frames: two that compile, one that is looked at, the rounds, and timed ones, which
/// wait for every pass.
const FRAMES: f64 = 3.0 + FEWEST_ROUNDS as f64 + 1.5 * TIMED as f64;
/// Times that outputs are made; the median counts.
const SHOWN: usize = 3;

/// The scenes of these names, all where none is named.
fn named(names: &[String]) -> Result<Vec<&'static Subject>> {
    let known: Vec<_> = SUBJECTS.iter().map(|subject| subject.name).collect();
    if let Some(name) = names.iter().find(|name| !known.contains(&name.as_str())) {
        return Err(Error::usage(
            format!("`bench` has no scene `{name}`"),
            format!("name one of {}", known.join(", ")),
        ));
    }
    let wanted = |subject: &&Subject| names.is_empty() || names.iter().any(|name| name == subject.name);
    Ok(SUBJECTS.iter().filter(wanted).collect())
}

/// Measures scene by scene, the small ones first; hands what there is so far to `keep` after each. What does not fit the
/// time or the adapter stands in the report with the reason. After Ctrl-C the report has what was finished.
///
/// # Errors
///
/// Where a scene is unknown, where the device fails, and what `keep` fails with.
pub fn run(settings: &Settings, mut keep: impl FnMut(&Report) -> Result<()>) -> Result<Report> {
    let start = Instant::now();
    let subjects = named(&settings.scenes)?;
    let scale = settings.size.scale();
    let bench = Bench::of(&settings.adapter, settings.quiet)?;
    let gpu = bench.gpu()?;
    let mut report = Report::new(machine(&gpu), scale.name, now());
    bench.tell(&format!("bench: {}", report.machine.name()));
    report.probes = probes::probe(&gpu, scale.probes)?;
    drop(gpu);
    // A file that cannot be written is told before anything takes long.
    keep(&report)?;
    // Of each scene: what its last size took, or why larger ones are left out.
    let mut known: Vec<std::result::Result<Option<Cost>, String>> =
        subjects.iter().map(|_| Ok(None)).collect();
    for &particles in scale.particles {
        for (subject, known) in subjects.iter().zip(&mut known) {
            let left = scale.limit - start.elapsed().as_secs_f64();
            let measured = match known {
                _ if interrupt::asked() => Err("interrupted".to_owned()),
                Err(why) => Err(why.clone()),
                Ok(_) if left <= 0.0 => Err("no time is left".to_owned()),
                Ok(Some(cost)) if cost.at(particles) > left => Err(format!(
                    "would take about {} of {} that are left",
                    seconds(cost.at(particles)),
                    seconds(left.max(0.0))
                )),
                Ok(_) => {
                    bench.tell(&format!(
                        "bench: {}, {} particles",
                        subject.name,
                        count(particles.into())
                    ));
                    match one(&bench, subject, particles, &scale, report.probes.as_ref()) {
                        Ok(measured) => Ok(measured),
                        Err(Error::Interrupted { .. }) => Err("interrupted".to_owned()),
                        Err(error) => Err(first_line(&error)),
                    }
                }
            };
            match measured {
                Ok((run, cost)) => {
                    report.runs.push(run);
                    *known = Ok(Some(cost));
                }
                Err(why) => {
                    report.left_out.push(LeftOut {
                        scene: subject.name.to_owned(),
                        particles,
                        why: why.clone(),
                    });
                    *known = Err(why);
                }
            }
            report.took_s = start.elapsed().as_secs_f64();
            report.interrupted = interrupt::heeded();
            keep(&report)?;
        }
    }
    Ok(report)
}

fn machine(gpu: &Gpu) -> Machine {
    let identity = Identity::of(&gpu.adapter);
    Machine {
        adapter: identity.name,
        kind: identity.kind.to_owned(),
        backend: identity.backend,
        driver: format!("{} {}", identity.driver, identity.driver_info)
            .trim()
            .to_owned(),
        processor: report::processor(),
        threads: std::thread::available_parallelism().map_or(1, usize::from),
        system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
    }
}

/// What a size took, to judge the next one.
struct Cost {
    particles: f64,
    /// Placing and compiling, and outputs, s.
    fixed: f64,
    /// s.
    frame: f64,
}

impl Cost {
    /// Seconds of another size, at least.
    fn at(&self, particles: u32) -> f64 {
        (self.fixed + FRAMES * self.frame) * f64::from(particles) / self.particles
    }
}

fn one(
    bench: &Bench,
    subject: &Subject,
    particles: u32,
    scale: &Scale,
    probes: Option<&Probes>,
) -> Result<(Run, Cost)> {
    let start = Instant::now();
    let scene = (subject.scene)(particles)?;
    let mut measured = Measured::new(bench, &scene, STEPS)?;
    let setup_s = start.elapsed().as_secs_f64();
    // A short burst decides how much fits.
    let burst = Instant::now();
    measured.round(1)?;
    let frame_s = burst.elapsed().as_secs_f64();
    measured.step_ms.clear();
    let frames = ((scale.round / frame_s).ceil() as u32).clamp(1, MOST_FRAMES);
    let rounds = if frame_s > scale.round {
        scale.rounds.min(FEWEST_ROUNDS)
    } else {
        scale.rounds
    };
    let (first, mut searches) = (measured.last.steps, 0);
    for _ in 0..rounds {
        measured.round(frames)?;
        searches += measured.searches;
    }
    let steps = measured.last.steps - first;
    let convergence = measured.last.convergence;
    for _ in 0..TIMED {
        measured.time_passes()?;
    }
    let state = measured.simulation.save_state()?;
    let (plan, step_ms) = (measured.plan.clone(), Spread::of(&measured.step_ms));
    // Its memory is free before what makes outputs takes some.
    let times = measured.times();
    let before_outputs = Instant::now();
    let (outputs, pairs) = outputs(bench, subject, &scene, &state)?;
    let run_particles = scene.first_boundary();
    let per_loop = |iterations: fn(&crate::physics::layout::Convergence) -> u32| {
        convergence.map_or(0.0, |c| f64::from(iterations(&c)) / f64::from(c.steps.max(1)))
    };
    let rates = Rates {
        searches: f64::from(searches) / steps.max(1) as f64,
        density_iterations: per_loop(|c| c.density_iterations),
        divergence_iterations: per_loop(|c| c.divergence_iterations),
        viscosity_iterations: per_loop(|c| c.viscosity_iterations),
        pairs: pairs as f64,
    };
    let demands = demand::of_step(&scene, &plan, rates)?;
    let share = |demanded: f64, ms: f64, rate: fn(&Probes) -> f64| {
        let probes = probes?;
        Some(demanded / (ms * 1e-3 * rate(probes))).filter(|share| share.is_finite())
    };
    let copy = |probes: &Probes| probes.copy_bytes_per_s;
    let compute = |probes: &Probes| probes.operations_per_s;
    let passes = times.passes.iter().map(|(name, ms)| {
        let demand = demands.get(name).copied().unwrap_or_default();
        PassTime {
            name: name.clone(),
            ms: *ms,
            copy_share: share(demand.bytes, *ms, copy),
            arithmetic_share: share(demand.operations, *ms, compute),
        }
    });
    let all = |of: fn(&demand::Demand) -> f64| demands.values().map(of).sum::<f64>();
    let rate = f64::from(run_particles) / (step_ms.median * 1e-3);
    let pairs_per_particle = pairs as f64 / f64::from(run_particles.max(1));
    let run = Run {
        scene: subject.name.to_owned(),
        particles: run_particles,
        boundary_particles: scene.boundary.len() as u32,
        rounds: rounds as usize,
        steps,
        step_ms,
        particle_steps_per_s: rate,
        pairs_per_particle,
        pairs_per_s: rate * pairs_per_particle,
        steps_per_search: steps as f64 / f64::from(searches.max(1)),
        copy_share: share(all(|d| d.bytes), step_ms.median, copy),
        arithmetic_share: share(all(|d| d.operations), step_ms.median, compute),
        passes: passes.collect(),
        outputs,
        setup_s,
        device_bytes: plan.bytes(),
    };
    let cost = Cost {
        particles: f64::from(particles),
        fixed: setup_s + before_outputs.elapsed().as_secs_f64(),
        frame: frame_s,
    };
    Ok((run, cost))
}

/// What outputs of a state cost, and its pairs as particles see them.
fn outputs(bench: &Bench, subject: &Subject, scene: &Scene, state: &State) -> Result<(Outputs, u64)> {
    let columns = Wanted {
        statistics: true,
        columns: columns_named(["position", "velocity", "contacts"])?,
        ..Wanted::default()
    };
    let (columns_ms, frame) = shown(bench, scene, state, &columns)?;
    let pairs = pairs(&frame);
    let mut outputs = Outputs {
        picture_ms: None,
        png_ms: None,
        columns_ms,
    };
    if subject.pictures {
        let view = View::Scene;
        let wanted = Wanted {
            view: Some(view),
            ..Wanted::default()
        };
        let (picture_ms, frame) = shown(bench, scene, state, &wanted)?;
        outputs.picture_ms = Some(picture_ms);
        let overlay = Overlay::new(scene, view)?;
        let start = Instant::now();
        if let Some(picture) = compose_picture(&frame, &overlay)? {
            encode_png(picture, Path::new("a picture"))?;
            outputs.png_ms = Some(start.elapsed().as_secs_f64() * 1e3);
        }
    }
    Ok((outputs, pairs))
}

/// Milliseconds of making a frame of a state and bringing it to the host, and the frame.
fn shown(bench: &Bench, scene: &Scene, state: &State, wanted: &Wanted) -> Result<(f64, Frame)> {
    let scene = scene.with_steps_per_frame(STEPS);
    let gpu = bench.gpu()?;
    let plan = Plan::new(&scene, &gpu.limits, wanted)?;
    let mut simulation = bench.with_plan(gpu, &scene, &plan)?;
    simulation.restore(state)?;
    let mut times = Vec::new();
    let mut last = Frame::default();
    // The first one compiles.
    for turn in 0..=SHOWN {
        let start = Instant::now();
        simulation.show(state.frame)?;
        if let Some(frame) = simulation.finish_frame()? {
            last = frame;
        }
        if turn > 0 {
            times.push(start.elapsed().as_secs_f64() * 1e3);
        }
    }
    Ok((crate::gpu::timing::median(times), last))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_are_found_by_name() {
        assert_eq!(named(&[]).unwrap().len(), SUBJECTS.len());
        assert_eq!(named(&["water_2d".into()]).unwrap().len(), 1);
        let told = named(&["fire".into()]).map(|_| ()).unwrap_err();
        assert!(told.to_string().contains("grains_settled"), "{told}");
    }

    #[test]
    fn a_larger_size_takes_longer_in_proportion() {
        let cost = Cost {
            particles: 1000.0,
            fixed: 1.0,
            frame: 0.5,
        };
        let once = 1.0 + FRAMES * 0.5;
        assert!((cost.at(1000) - once).abs() < 1e-12 && (cost.at(4000) - 4.0 * once).abs() < 1e-12);
    }
}
