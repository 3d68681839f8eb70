//! Taylor–Green vortices in a periodic square.

use super::Case;
use super::fluid::{flow, record, shipped, spacing};
use crate::error::Result;
use crate::scene::Scene;
use crate::study::Size;
use crate::study::accuracy::norms::relative_l1;
use crate::study::accuracy::published;
use crate::study::accuracy::record::{Bar, Figure, Record};
use crate::study::accuracy::theory::taylor_green::TaylorGreen;
use crate::study::bench::Bench;

pub const CASE: Case = Case {
    name: "taylor_green_2d",
    title: "Taylor–Green vortices, Re 100",
    about: "Vortices in a periodic unit square decay at the rate −8π²/Re (scene `taylor_green_2d`, t = 2 s). The figure \
            is the mean of |V − Vₑ| over the mean of Vₑ, with V the particles' speeds, averaged over all frames after \
            the first. The plain solver of Rojas 2013 (density by summation, symmetric pressure, no shifting) has its \
            own row.",
    resolution: "particles across",
    label: |n| format!("{n}²"),
    resolutions: |size| match size {
        Size::Tiny => &[25],
        Size::Small => &[25, 50],
        Size::Full => &[25, 50, 100],
    },
    figure: FIGURE,
    published: published::TAYLOR_GREEN,
    run: both_solvers,
};

const FIGURE: &str = "L1 of speed";
/// Rojas 2013, Eq. 1 to 7.
const PLAIN: [&str; 5] = [
    "fluid.density_from=summation",
    "fluid.density_diffusion=0",
    "fluid.pressure_force=symmetric",
    "fluid.gradient_correction=false",
    "fluid.shifting=0",
];

fn both_solvers(bench: &Bench, _: Size, n: u32) -> Result<Vec<Record>> {
    let shifted = one(bench, n, &[])?;
    let plain = one(bench, n, &PLAIN.map(str::to_owned))?;
    Ok(vec![shifted, plain])
}

/// The case's scene with other keys changed.
pub fn scene(n: u32, changes: &[String]) -> Result<Scene> {
    shipped(CASE.name, &[&[spacing(1.0, n)], changes].concat())
}

/// The record of one run.
pub fn one(bench: &Bench, n: u32, changes: &[String]) -> Result<Record> {
    let scene = scene(n, changes)?;
    let truth = TaylorGreen::unit(100.0);
    let mut errors = Vec::new();
    let (mut decay, mut energy) = (0.0_f64, 0.0_f64);
    let run = flow(bench, &scene, |flow| {
        let speed = |v: &glam::DVec3| v.length();
        let expected = flow.position.iter().map(|p| {
            let [u, v] = truth.velocity([p.x, p.y], flow.time);
            u.hypot(v)
        });
        if flow.time > 0.0 {
            errors.push(relative_l1(flow.velocity.iter().map(speed).zip(expected)));
            let largest = truth.largest_speed(flow.time);
            decay = decay.max((flow.largest_speed() / largest - 1.0).abs());
            let count = flow.velocity.len() as f64;
            let mean = flow
                .velocity
                .iter()
                .map(|v| 0.5 * v.length_squared())
                .sum::<f64>()
                / count;
            energy = energy.max((mean / truth.energy(flow.time) - 1.0).abs());
        }
    })?;
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    let mut figure = Figure::new(FIGURE, 100.0 * mean, "%").bar((n >= 100).then_some(Bar::AtMost(1.0)));
    if let Some(best) = published::TAYLOR_GREEN[0].error_at(n) {
        figure = figure.best(best, published::TAYLOR_GREEN[0].method);
    }
    let last = errors.last().copied().map(|error| 100.0 * error);
    let figures = vec![
        figure,
        Figure::new("L1 of speed at the end", last, "%"),
        Figure::new("worst of largest speed", 100.0 * decay, "%"),
        Figure::new("worst of energy", 100.0 * energy, "%"),
    ];
    Ok(record(bench, CASE.name, &scene, n, run, figures))
}
