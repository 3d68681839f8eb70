//! The longest stable time step of each solver, by bisection, beside theory.

use super::Scale;
use super::methods::{EXPECTED, Method, SPACING, block, with_fixed_steps};
use super::theory;
use super::trial::{Trial, lost, run};
use crate::error::Result;
use crate::output::plot::Bars;
use crate::scene::Scene;
use crate::study::bench::Bench;
use crate::study::page::{Cell, Page, Table};

/// Steps of a lattice, in which a mode that grows by a fifth a step grows a thousandfold.
const LATTICE_STEPS: u32 = 40;
/// Displacement of the lattice's points at the start, as a share of the spacing.
const NOISE: f64 = 1e-3;
/// Of ρ/ρ₀ − 1 at the start.
const DENSITY_NOISE: f32 = 1e-3;
/// A lattice is unstable where something moves faster than this share of the speed of sound.
const FAST: f64 = 0.1;
/// Grains of a column, and its steps.
const COLUMN: u32 = 8;
const COLUMN_STEPS: u32 = 600;
/// A column is unstable where a grain moves faster than this many times what its weight does; its sway does six times.
const THROWN: f64 = 20.0;
/// A dam may gain this share of its energy, by rounding and by what its particles are pressed.
const GAIN: f64 = 0.02;

/// One row: a scene whose runs are stable or not.
struct Case {
    method: &'static str,
    scene_name: &'static str,
    scene: Scene,
    /// Seconds: by theory, and what the scene takes by itself.
    theory: Option<f64>,
    usual: f64,
    /// Steps of a run with a step of so many seconds.
    steps: Box<dyn Fn(f64) -> u32>,
    is_stable: Box<Judge>,
}

/// Whether what became of a scene is stable.
type Judge = dyn Fn(&Scene, &Trial) -> bool;

/// The longest stable step and the shortest unstable one that were tried; `None` where the interval's end was neither.
struct Found {
    stable: Option<f64>,
    unstable: Option<f64>,
}

pub fn longest(page: &mut Page, bench: &Bench, scale: &Scale) -> Result<()> {
    page.heading("The longest stable time step");
    page.paragraph(
        "By bisection over the step. *Lattice*: inviscid fluid in a periodic square, displaced by a thousandth of the \
         spacing; unstable where a particle reaches a tenth of the speed of sound within 40 steps. Theory is that of \
         sound waves on the lattice, ω Δt = 2 for the fastest wave. *Dam*: a breaking dam with artificial viscosity 0.05, \
         unstable where it gains 2 % of its energy or loses a particle; no theory gives its limit, so it is put beside \
         the step that scenes take (0.5 h over the speed of sound and of the flow, 0.25 h of `sph`). *Column*: eight grains \
         one above the other, restitution 0.5, unstable where they move after 600 steps; theory is that of the \
         fastest mode of the chain with its dashpots, for symplectic Euler, which takes both integrators here.",
    );
    let mut table = Table::new([
        "solver",
        "scene",
        "longest stable, µs",
        "shortest unstable, µs",
        "theory, µs",
        "stable over theory",
        "scene's own step, µs",
        "stable over own",
    ]);
    let mut names = Vec::new();
    let mut ours = Vec::new();
    let mut expected = Vec::new();
    let mut usual = Vec::new();
    for case in cases(scale)? {
        bench.tell(&format!(
            "stability: steps of {}, {}",
            case.method, case.scene_name
        ));
        let found = bisect(bench, &case, scale.halvings)?;
        let micro = |seconds: Option<f64>| Cell::maybe(seconds.map(|s| s * 1e6));
        let ratio = |to: Option<f64>| Cell::maybe(found.stable.zip(to).map(|(a, b)| a / b));
        table.row([
            Cell::text(case.method),
            Cell::text(case.scene_name),
            micro(found.stable),
            micro(found.unstable),
            micro(case.theory),
            ratio(case.theory),
            micro(Some(case.usual)),
            ratio(Some(case.usual)),
        ]);
        names.push(format!(
            "{}\n{}",
            case.method.replace(", ", "\n"),
            case.scene_name
        ));
        ours.push(found.stable.map_or(f64::NAN, |s| s * 1e6));
        expected.push(case.theory.map_or(f64::NAN, |s| s * 1e6));
        usual.push(case.usual * 1e6);
    }
    page.table("steps", &table);
    let chart = Bars::new("The longest stable time step", "µs", names)
        .series("measured", ours)
        .series("theory", expected)
        .series("the scene's own", usual)
        .size(1200, 600)
        .log_y();
    page.picture(
        "stability_steps.png",
        "Longest stable steps beside theory.",
        |path| chart.save(path),
    )
}

fn cases(scale: &Scale) -> Result<Vec<Case>> {
    let mut cases = Vec::new();
    let (fluids, grains): (Vec<_>, Vec<_>) = with_fixed_steps().partition(|method| method.is_fluid);
    for method in &fluids {
        cases.push(lattice(*method)?);
    }
    for method in fluids {
        cases.push(dam(method, scale.dam_seconds)?);
    }
    for method in grains {
        cases.push(column(method)?);
    }
    Ok(cases)
}

/// What a scene takes by itself, before it is fit into frames.
fn usual_step(scene: &Scene) -> f64 {
    let gravity = f64::from(scene.gravity.length());
    let limits = scene.fluid().map(|fluid| fluid.step_limits(gravity));
    limits.map_or(scene.time.step, |limits| {
        limits.iter().map(|(step, _)| *step).fold(f64::INFINITY, f64::min)
    })
}

fn lattice(method: Method) -> Result<Case> {
    let mut body = block([0.0; 2], 20, 20);
    body["jitter"] = NOISE.into();
    let mut scene = method.scene(body, |file| {
        file["domain"] = serde_json::json!({ "min": [0, 0], "max": [20.0 * SPACING, 20.0 * SPACING], "walls": "periodic" });
        file["gravity"] = serde_json::json!([0, 0]);
        file["fluid"]["artificial_viscosity"] = 0.into();
        file["fluid"]["max_speed"] = EXPECTED.into();
        file["fluid"]["negative_pressure"] = "keep".into();
        if file["fluid"]["density_from"] == "continuity" {
            file["fluid"]["density_diffusion"] = 0.into();
        }
    })?;
    // Displacements alone do not show where density follows from the flow.
    for (k, deviation) in scene.particles.density_deviation.iter_mut().enumerate() {
        *deviation = DENSITY_NOISE * (12.9898 * k as f32).sin();
    }
    Ok(Case {
        method: method.name,
        scene_name: "lattice",
        theory: scene.fluid().map(theory::sound_limit),
        usual: usual_step(&scene),
        scene,
        steps: Box::new(|_| LATTICE_STEPS),
        is_stable: Box::new(|scene, trial| {
            let sound = scene.fluid().map_or(f64::NAN, |fluid| fluid.sound_speed);
            trial.moments.iter().all(|m| m.figures.max_speed < FAST * sound)
        }),
    })
}

fn dam(method: Method, seconds: f64) -> Result<Case> {
    let scene = method.scene(block([0.0; 2], 16, 12), |file| {
        file["domain"]["max"] = serde_json::json!([1, 0.6]);
    })?;
    Ok(Case {
        method: method.name,
        scene_name: "dam",
        theory: None,
        usual: usual_step(&scene),
        scene,
        steps: Box::new(move |step| (seconds / step).ceil() as u32),
        is_stable: Box::new(|scene, trial| {
            let most = (1.0 + GAIN) * trial.moments[0].energy();
            lost(scene, &trial.last) == 0 && trial.moments.iter().all(|m| m.energy() <= most)
        }),
    })
}

fn column(method: Method) -> Result<Case> {
    let scene = method.scene(block([0.5, 0.0], 1, COLUMN), |_| {})?;
    let grains = scene.grains().expect("grains");
    let contact = &grains.contact;
    // What a grain's weight presses a spring at in a time unit of the contact.
    let slow = f64::from(scene.gravity.length()) * (grains.mass / contact.spring).sqrt();
    Ok(Case {
        method: method.name,
        scene_name: "column",
        theory: Some(theory::column_limit(
            contact.spring,
            contact.damping,
            grains.mass,
            COLUMN,
        )),
        usual: usual_step(&scene),
        scene,
        steps: Box::new(|_| COLUMN_STEPS),
        is_stable: Box::new(move |_, trial| {
            trial
                .moments
                .last()
                .is_some_and(|m| m.figures.max_speed < THROWN * slow)
        }),
    })
}

/// Looks between a quarter of what is expected and four times that.
fn bisect(bench: &Bench, case: &Case, halvings: u32) -> Result<Found> {
    let is_stable = |step: f64| -> Result<bool> {
        let mut scene = case.scene.clone();
        scene.time.step = step;
        let frames = 4;
        let trial = run(bench, &scene, (case.steps)(step).div_ceil(frames), frames)?;
        Ok(trial.is_ok_and(|trial| (case.is_stable)(&scene, &trial)))
    };
    let middle = case.theory.unwrap_or(2.0 * case.usual);
    let (mut low, mut high) = (middle / 4.0, middle * 4.0);
    if !is_stable(low)? {
        return Ok(Found {
            stable: None,
            unstable: Some(low),
        });
    }
    if is_stable(high)? {
        return Ok(Found {
            stable: Some(high),
            unstable: None,
        });
    }
    for _ in 0..halvings {
        let step = (low * high).sqrt();
        if is_stable(step)? {
            low = step;
        } else {
            high = step;
        }
    }
    Ok(Found {
        stable: Some(low),
        unstable: Some(high),
    })
}
