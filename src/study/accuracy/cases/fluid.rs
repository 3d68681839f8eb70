//! What cases of fluids share: scenes that ship, with other resolutions and methods, and what their frames hold.

use glam::DVec3;
use serde::Serialize;

use super::columns::{scalars, vectors};
use crate::error::Result;
use crate::scene::fluid::usual_support;
use crate::scene::model::{DensityFrom, PressureForce, Slip, Wall};
use crate::scene::{Scene, library, load};
use crate::study::accuracy::record::{Figure, Method, Record};
use crate::study::accuracy::run::{Run, run};
use crate::study::bench::Bench;

/// The scene of this name as it ships, with these keys changed.
pub fn shipped(name: &str, overrides: &[String]) -> Result<Scene> {
    let text = library::find(name).ok_or_else(|| library::unknown(name))?;
    load::parse(text, &format!("{name}.json"), &library::folder()?, overrides)
}

/// `fluid.spacing` for so many particles over a length (m).
pub fn spacing(length: f64, across: u32) -> String {
    format!("fluid.spacing={:e}", length / f64::from(across))
}

/// The fluid at one moment, in order of id. z = 0 in 2D.
pub struct Flow {
    /// s.
    pub time: f64,
    /// m.
    pub position: Vec<DVec3>,
    /// m/s.
    pub velocity: Vec<DVec3>,
    /// Pa.
    pub pressure: Vec<f64>,
}

impl Flow {
    /// m/s.
    pub fn largest_speed(&self) -> f64 {
        self.velocity.iter().map(|v| v.length()).fold(0.0, f64::max)
    }
}

/// Runs a scene and hands each moment, the initial state first, to `each`.
pub fn flow(bench: &Bench, scene: &Scene, mut each: impl FnMut(&Flow)) -> Result<Run> {
    run(bench, scene, &["position", "velocity", "pressure"], |frame| {
        each(&Flow {
            time: frame.time,
            position: vectors(frame, "position"),
            velocity: vectors(frame, "velocity"),
            pressure: scalars(frame, "pressure"),
        });
    })
}

/// The record of a run of `scene`. A run that broke off keeps the figures' names alone.
pub fn record(
    bench: &Bench,
    case: &str,
    scene: &Scene,
    resolution: u32,
    run: Run,
    mut figures: Vec<Figure>,
) -> Record {
    if run.diverged.is_some() {
        for figure in &mut figures {
            figure.value = None;
        }
    }
    let spacing = scene.fluid().map_or(0.0, |fluid| fluid.spacing);
    run.record(bench, case, method(scene), resolution, spacing, figures)
}

fn word(value: impl Serialize) -> String {
    let value = serde_json::to_value(value).expect("a word");
    value.as_str().unwrap_or_default().to_owned()
}

fn method(scene: &Scene) -> Method {
    let Some(fluid) = scene.fluid() else {
        return Method::default();
    };
    let usual_support = usual_support(
        scene.dimensions,
        fluid.solver,
        fluid.kernel,
        fluid.density_from,
        fluid.has_surface_tension(),
    );
    let planes = scene
        .domain
        .sides
        .iter()
        .flatten()
        .any(|&side| side == Wall::Planes);
    let walls = [(planes, "planes"), (!scene.boundary.is_empty(), "particles")];
    let walls = walls.iter().find(|(there, _)| *there).map(|(_, word)| *word);
    let viscous = fluid.materials.iter().any(|material| material.viscosity > 0.0);
    let support = fluid.support / fluid.spacing;
    let options = [
        (
            fluid.density_from == DensityFrom::Summation,
            "density by summation".to_owned(),
        ),
        (
            fluid.density_diffusion > 0.0,
            format!("density diffusion {}", fluid.density_diffusion),
        ),
        (
            fluid.pressure_force != PressureForce::Symmetric,
            format!("pressure by {}", word(fluid.pressure_force)),
        ),
        (fluid.gradient_correction, "corrected gradients".to_owned()),
        (fluid.shifting > 0.0, format!("shifting {}", fluid.shifting)),
        (
            fluid.artificial_viscosity > 0.0,
            format!("artificial viscosity {}", fluid.artificial_viscosity),
        ),
        (
            (support - usual_support).abs() > 1e-6,
            format!("support {support:.1}"),
        ),
        (
            walls.is_some() && fluid.slip == Slip::FreeSlip,
            "free slip".to_owned(),
        ),
        (
            fluid.wall_friction > 0.0,
            format!("wall friction {}", fluid.wall_friction),
        ),
    ];
    Method {
        solver: word(fluid.solver),
        kernel: Some(word(fluid.kernel)),
        viscosity: viscous.then(|| word(fluid.viscosity_form)),
        integrator: word(scene.time.integrator),
        walls: walls.map(|word| format!("walls of {word}")),
        options: options
            .into_iter()
            .filter(|(on, _)| *on)
            .map(|(_, text)| text)
            .collect(),
    }
}
