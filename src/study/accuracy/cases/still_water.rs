//! Water at rest in a tank.

use super::Case;
use super::fluid::{flow, record, shipped, spacing};
use crate::error::Result;
use crate::scene::Scene;
use crate::study::Size;
use crate::study::accuracy::norms::Norms;
use crate::study::accuracy::published;
use crate::study::accuracy::record::{Bar, Figure, Record};
use crate::study::accuracy::theory::still_water::StillWater;
use crate::study::bench::Bench;

pub const CASE: Case = Case {
    name: "still_water",
    title: "Still water",
    about: "Water rests in a square tank of unit depth under unit gravity (scene `still_water`). Truth is the Tait \
            equation's hydrostatic profile of the same mass, so that the pressure at the floor is ρ₀gH. Errors of the \
            particles' pressures are averaged over the last second and given over ρ₀gH; the largest speed is the \
            largest of that second, over √(gH). Small studies end after 5 √(H/g), full ones after 100.",
    resolution: "particles deep",
    label: |n| n.to_string(),
    resolutions: |size| match size {
        Size::Tiny => &[15],
        Size::Small => &[45],
        Size::Full => &[45, 90],
    },
    figure: FIGURE,
    published: published::STILL_WATER,
    run: all_methods,
};

const FIGURE: &str = "L1 of pressure";
const METHODS: [&[&str]; 3] = [
    &["domain.walls=particles"],
    &["domain.walls=planes"],
    &["domain.walls=particles", "fluid.support=4"],
];

fn all_methods(bench: &Bench, size: Size, n: u32) -> Result<Vec<Record>> {
    METHODS
        .iter()
        .map(|changes| {
            one(
                bench,
                size,
                n,
                &changes
                    .iter()
                    .map(|&change| change.to_owned())
                    .collect::<Vec<_>>(),
            )
        })
        .collect()
}

/// s.
fn duration(size: Size) -> f64 {
    match size {
        Size::Full => 100.0,
        Size::Tiny | Size::Small => 5.0,
    }
}

/// The case's scene with other keys changed.
pub fn scene(size: Size, n: u32, changes: &[String]) -> Result<Scene> {
    let of_case = [spacing(1.0, n), format!("time.duration={}", duration(size))];
    shipped(CASE.name, &[&of_case, changes].concat())
}

/// Water of depth one before it is compressed by its own weight.
fn truth(scene: &Scene) -> Option<StillWater> {
    let fluid = scene.fluid()?;
    let (gamma, squared) = (f64::from(fluid.gamma), fluid.sound_speed * fluid.sound_speed);
    let density = fluid.materials[0].density;
    // At the floor p = ρ₀gH, and (ρ/ρ₀)^(γ−1) = 1 + (γ−1) g H′/c² at depth H′.
    let ratio = (1.0 + gamma / squared).powf(1.0 / gamma);
    let depth = if gamma > 1.0 {
        (ratio.powf(gamma - 1.0) - 1.0) * squared / (gamma - 1.0)
    } else {
        ratio.ln() * squared
    };
    Some(StillWater {
        depth,
        gravity: 1.0,
        density,
        sound_speed: fluid.sound_speed,
        gamma,
    })
}

/// The record of one run.
pub fn one(bench: &Bench, size: Size, n: u32, changes: &[String]) -> Result<Record> {
    let duration = duration(size);
    let scene = scene(size, n, changes)?;
    let truth = truth(&scene);
    let (mut l1, mut largest, mut moments, mut speed) = (0.0, 0.0, 0.0, 0.0_f64);
    let (mut fastest, mut pressure_scale) = (0.0_f64, 1.0);
    let run = flow(bench, &scene, |flow| {
        fastest = fastest.max(flow.largest_speed());
        if let Some(truth) = truth.filter(|_| flow.time > duration - 1.0) {
            pressure_scale = truth.pressure(0.0);
            let pairs = flow.position.iter().zip(&flow.pressure);
            // A particle that stands higher than the surface has no pressure.
            let pairs = pairs.map(|(at, &p)| (p, truth.pressure(at.y.min(truth.depth))));
            let norms = Norms::new(pairs).over(pressure_scale);
            l1 += norms.l1;
            largest += norms.largest;
            moments += 1.0;
            speed = speed.max(flow.largest_speed());
        }
    })?;
    let judged = |bar: f64| (n >= 45).then_some(Bar::AtMost(bar));
    let mut figure = Figure::new(FIGURE, 100.0 * l1 / moments, "%").bar(judged(0.3));
    if let Some(best) = published::STILL_WATER[0].error_at(n) {
        figure = figure.best(best, published::STILL_WATER[0].method);
    }
    let mut worst = Figure::new("largest error of pressure", 100.0 * largest / moments, "%").bar(judged(1.5));
    let mut residual = Figure::new("largest speed at the end", speed, "√(gH)").bar(judged(1e-3));
    if n == 45 {
        worst = worst.best(1.4, "PySPH, Adami's walls, t = 2 s (up to 2.4 in other variants)");
        residual = residual.best(1.8e-3, "PySPH, Adami's walls, t = 2 s");
    }
    let figures = vec![
        figure,
        worst,
        residual,
        Figure::new("largest speed of all", fastest, "√(gH)"),
    ];
    Ok(record(bench, CASE.name, &scene, n, run, figures))
}
