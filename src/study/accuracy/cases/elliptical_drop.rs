//! A drop in flight that its own motion stretches.

use super::Case;
use super::fluid::{flow, record, shipped, spacing};
use crate::error::Result;
use crate::study::Size;
use crate::study::accuracy::record::{Bar, Figure, Record};
use crate::study::accuracy::spread;
use crate::study::accuracy::theory::elliptical_drop::Ellipse;
use crate::study::bench::Bench;

pub const CASE: Case = Case {
    name: "elliptical_drop",
    title: "A drop that is stretched",
    about: "A round drop, R = 1 m, moves with the velocity (−100 x, 100 y) 1/s and becomes an ellipse (scene \
            `elliptical_drop`; Monaghan 1994). Its axes after 7.6 ms, √⟨y²⟩ and √⟨x²⟩ over those at the start, beside the \
            exact ones; its kinetic energy beside that at the start, which stays.",
    resolution: "particles over the radius",
    label: |n| format!("R/{n}"),
    resolutions: |size| match size {
        Size::Tiny => &[10],
        Size::Small => &[20],
        Size::Full => &[20, 40],
    },
    figure: FIGURE,
    published: &[],
    run: |bench, _, n| Ok(vec![one(bench, n)?]),
};

const FIGURE: &str = "long axis";
/// 1/s.
const RATE: f64 = 100.0;

fn one(bench: &Bench, n: u32) -> Result<Record> {
    let scene = shipped(CASE.name, &[spacing(1.0, n)])?;
    let spacing = 1.0 / f64::from(n);
    let (mut start, mut energy, mut long, mut short) = (None, 0.0, 0.0, 0.0);
    let mut closest = f64::INFINITY;
    let run = flow(bench, &scene, |flow| {
        let mean = |of: &dyn Fn(usize) -> f64| {
            (0..flow.position.len()).map(of).sum::<f64>() / flow.position.len() as f64
        };
        let now = [
            mean(&|i| flow.velocity[i].length_squared()),
            mean(&|i| flow.position[i].y.powi(2)),
            mean(&|i| flow.position[i].x.powi(2)),
        ];
        let [energy_0, long_0, short_0] = *start.get_or_insert(now);
        let truth = Ellipse::at(RATE, flow.time);
        energy = now[0] / energy_0 - 1.0;
        long = (now[1] / long_0).sqrt() * truth.short - 1.0;
        short = (now[2] / short_0).sqrt() / truth.short - 1.0;
        closest = closest.min(spread::closest(&flow.position, spacing) / spacing);
    })?;
    let judged = |most: f64| (n >= 40).then_some(Bar::Within(-most, most));
    let (long_best, energy_best) = match n {
        20 => (Some(-0.90), Some(-6.2)),
        40 => (Some(-0.38), Some(-3.1)),
        80 => (Some(-0.18), Some(-1.65)),
        _ => (None, None),
    };
    let beside = |figure: Figure, best: Option<f64>| match best {
        Some(best) => figure.best(best, "PySPH 1.0b2, elliptical_drop"),
        None => figure,
    };
    let figures = vec![
        beside(Figure::new(FIGURE, 100.0 * long, "%").bar(judged(0.2)), long_best),
        Figure::new("short axis", 100.0 * short, "%").bar(judged(1.0)),
        beside(
            Figure::new("kinetic energy", 100.0 * energy, "%").bar(judged(1.0)),
            energy_best,
        ),
        Figure::new("nearest two particles", closest, "spacings").bar((n >= 40).then_some(Bar::AtLeast(0.4))),
    ];
    Ok(record(bench, CASE.name, &scene, n, run, figures))
}
