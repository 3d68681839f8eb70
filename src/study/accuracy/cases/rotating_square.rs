//! A square of fluid that turns, without walls or weight.

use glam::DVec3;

use super::Case;
use super::fluid::{flow, record, shipped, spacing};
use crate::error::Result;
use crate::study::Size;
use crate::study::accuracy::record::{Bar, Figure, Record};
use crate::study::accuracy::spread;
use crate::study::accuracy::theory::rotating_square::pressure;
use crate::study::bench::Bench;

pub const CASE: Case = Case {
    name: "rotating_square",
    title: "A square that turns",
    about: "A square of water turns like a rigid body, without walls or weight, and grows arms (scene \
            `rotating_square`; Colagrossi 2005). It begins with the pressure of that motion, which is negative all over. \
            Nothing acts on it, so kinetic energy and angular momentum stay; figures are their largest errors up to \
            ωt = 2. Particles within 2 spacings are in one piece.",
    resolution: "particles along a side",
    label: |n| format!("{n}²"),
    resolutions: |size| match size {
        Size::Tiny => &[20],
        Size::Small => &[40],
        Size::Full => &[40, 80],
    },
    figure: FIGURE,
    published: &[],
    run: |bench, _, n| Ok(vec![one(bench, n)?]),
};

const FIGURE: &str = "kinetic energy";

fn one(bench: &Bench, n: u32) -> Result<Record> {
    let mut scene = shipped(CASE.name, &[spacing(1.0, n)])?;
    let spacing = 1.0 / f64::from(n);
    let fluid = scene.fluid().expect("the scene has a fluid").clone();
    let origin = scene.origin;
    let density = fluid.materials[0].density;
    let places = scene.particles.position.iter();
    scene.particles.density_deviation = places
        .map(|p| {
            let at = p.as_dvec3() + origin + 0.5;
            fluid.deviation_at(density, density * pressure([at.x, at.y])) as f32
        })
        .collect();
    let (mut start, mut energy, mut momentum) = (None, 0.0_f64, 0.0_f64);
    let (mut closest, mut whole) = (f64::INFINITY, 1.0_f64);
    let run = flow(bench, &scene, |flow| {
        let turn = |(x, v): (&DVec3, &DVec3)| x.x * v.y - x.y * v.x;
        let both = flow.position.iter().zip(&flow.velocity);
        let now = (
            flow.velocity.iter().map(|v| v.length_squared()).sum::<f64>(),
            both.map(turn).sum::<f64>(),
        );
        let (energy_0, momentum_0) = *start.get_or_insert(now);
        let larger = |worst: f64, change: f64| if change.abs() > worst.abs() { change } else { worst };
        energy = larger(energy, now.0 / energy_0 - 1.0);
        momentum = larger(momentum, now.1 / momentum_0 - 1.0);
        closest = closest.min(spread::closest(&flow.position, spacing) / spacing);
        let largest = spread::pieces(&flow.position, 2.0 * spacing)[0];
        whole = whole.min(largest as f64 / flow.position.len() as f64);
    })?;
    let judged = |bar: Bar| (n >= 80).then_some(bar);
    let figures = vec![
        Figure::new(FIGURE, 100.0 * energy, "%").bar(judged(Bar::Within(-2.0, 2.0))),
        Figure::new("angular momentum", 100.0 * momentum, "%").bar(judged(Bar::Within(-2.0, 2.0))),
        Figure::new("particles in the largest piece", 100.0 * whole, "%").bar(judged(Bar::AtLeast(100.0))),
        Figure::new("nearest two particles", closest, "spacings").bar(judged(Bar::AtLeast(0.4))),
    ];
    Ok(record(bench, CASE.name, &scene, n, run, figures))
}
