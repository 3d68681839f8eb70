//! Flow between a turning and a resting cylinder.

use glam::DVec3;

use super::Case;
use super::fluid::{Flow, flow, record, shipped, spacing};
use crate::error::Result;
use crate::study::Size;
use crate::study::accuracy::norms::Norms;
use crate::study::accuracy::record::{Bar, Figure, Record};
use crate::study::accuracy::theory::taylor_couette::TaylorCouette;
use crate::study::bench::Bench;

pub const CASE: Case = Case {
    name: "taylor_couette",
    title: "Flow between cylinders, Re 10",
    about: "The inner cylinder (radius 1) turns with unit angular speed, the outer one (radius 2) rests (scene \
            `taylor_couette`). After 10 s the start has decayed by exp(−π²) ≈ 5e-5. Angular speeds and pressures of all \
            particles are compared with u = Ar + B/r and dp/dr = ρu²/r; errors are L2 norms, over the inner angular \
            speed and over the rise of pressure across the gap. Pressure counts from its mean, which a closed gap \
            leaves free.",
    resolution: "particles across the gap",
    label: |n| n.to_string(),
    resolutions: |size| match size {
        Size::Tiny => &[10],
        Size::Small => &[10, 20],
        Size::Full => &[10, 20, 40],
    },
    figure: ANGULAR_SPEED,
    published: &[],
    run: |bench, _, n| Ok(vec![one(bench, n)?]),
};

const ANGULAR_SPEED: &str = "L2 of angular speed";
const TRUTH: TaylorCouette = TaylorCouette {
    radii: [1.0, 2.0],
    turns: [1.0, 0.0],
    density: 1.0,
};

fn one(bench: &Bench, n: u32) -> Result<Record> {
    let overrides = [spacing(1.0, n), "time.duration=10".to_owned()];
    let scene = shipped(CASE.name, &overrides)?;
    let mut errors = [f64::NAN; 2];
    let run = flow(bench, &scene, |flow| {
        errors = [angular_speed(flow), pressure(flow)]
    })?;
    let [speed, pressure] = errors.map(|error| 100.0 * error);
    let bar = (n >= 40).then_some(Bar::AtMost(1.0));
    let figures = vec![
        Figure::new(ANGULAR_SPEED, speed, "%").bar(bar),
        Figure::new("L2 of pressure", pressure, "%").bar(bar),
    ];
    Ok(record(bench, CASE.name, &scene, n, run, figures))
}

fn angular_speed(flow: &Flow) -> f64 {
    let pairs = flow.position.iter().zip(&flow.velocity).map(|(p, v)| {
        let squared = p.length_squared();
        let turns: DVec3 = p.cross(*v) / squared;
        (turns.z, TRUTH.angular_speed(squared.sqrt()))
    });
    Norms::new(pairs).over(TRUTH.turns[0]).l2
}

fn pressure(flow: &Flow) -> f64 {
    let off: Vec<f64> = flow
        .position
        .iter()
        .zip(&flow.pressure)
        .map(|(p, found)| found - TRUTH.pressure(p.length()))
        .collect();
    let mean = off.iter().sum::<f64>() / off.len() as f64;
    let scale = TRUTH.pressure(TRUTH.radii[1]);
    Norms::new(off.into_iter().map(|off| (off, mean))).over(scale).l2
}
