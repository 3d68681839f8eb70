//! Martin and Moyce's column of water.

use glam::DVec3;

use super::Case;
use super::fluid::{flow, record, shipped, spacing};
use crate::error::Result;
use crate::scene::Scene;
use crate::study::Size;
use crate::study::accuracy::norms::Norms;
use crate::study::accuracy::record::{Bar, Figure, Record};
use crate::study::accuracy::reference;
use crate::study::accuracy::sampler::Sampler;
use crate::study::accuracy::series::Series;
use crate::study::bench::Bench;

pub const CASE: Case = Case {
    name: "martin_moyce",
    title: "Collapse of a column of water",
    about: "A square column, a = 2.25 in, collapses over a dry floor (scene `martin_moyce`; Martin and Moyce 1952, \
            n² = 1). The front Z = x/a is where the farthest particle ends; its figure is the root of the mean square \
            of ΔZ/Z over the measured points, with the best shift of time of at most 0.2 T, since the origin of the \
            measured times is uncertain by some 0.15 T. How much that alone makes is given too: the error of the \
            measured curve beside itself, 0.15 T later. Heights at the back wall likewise, without a shift.",
    resolution: "particles high",
    label: |n| n.to_string(),
    resolutions: |size| match size {
        Size::Tiny => &[10],
        Size::Small => &[20, 40],
        Size::Full => &[20, 40, 80],
    },
    figure: FIGURE,
    published: &[],
    run: |bench, _, n| Ok(vec![one(bench, n, &[])?]),
};

const FIGURE: &str = "front, shifted";
/// Width and height of the column, m.
const A: f64 = 0.05715;
const GRAVITY: f64 = 9.81;
/// In units of √(a/g).
const MOST_SHIFT: f64 = 0.2;
/// By which the origin of the measured times is uncertain, √(a/g).
const UNCERTAIN: f64 = 0.15;

/// The case's scene with other keys changed.
pub fn scene(n: u32, changes: &[String]) -> Result<Scene> {
    shipped(CASE.name, &[&[spacing(A, n)], changes].concat())
}

/// The error of a front, x/a over √(a/g) of time, as the case judges it, percent; none unless it reaches all measured
/// points.
pub fn front_error(front: &Series) -> Result<Option<f64>> {
    let [measured, _] = reference::martin_moyce(1)?;
    Ok(front.best_fit(&measured, MOST_SHIFT).map(|fit| 100.0 * fit.rms))
}

/// The record of one run.
pub fn one(bench: &Bench, n: u32, changes: &[String]) -> Result<Record> {
    let scene = scene(n, changes)?;
    let spacing = A / f64::from(n);
    let unit = (A / GRAVITY).sqrt();
    let (mut front, mut height) = (Series::default(), Series::default());
    let run = flow(bench, &scene, |flow| {
        let farthest = flow.position.iter().map(|p| p.x).fold(0.0, f64::max);
        front.push(flow.time / unit, (farthest + 0.5 * spacing) / A);
        let sampler = Sampler::new(&flow.position, 2, spacing, None);
        let at = DVec3::new(0.5 * spacing, 0.0, 0.0);
        height.push(flow.time / unit, sampler.height(at, 1.2 * A) / A);
    })?;
    let [measured_front, measured_height] = reference::martin_moyce(1)?;
    let percent = |value: Option<f64>| value.map(|value| 100.0 * value);
    let best = front.best_fit(&measured_front, MOST_SHIFT);
    let heights = measured_height
        .points()
        .filter_map(|(t, h)| Some((height.at(t)? / h, 1.0)));
    // A front that is exactly the measured one, but on a clock that started later.
    let late = measured_front.points().last().and_then(|(last, _)| {
        let reached = measured_front.within(0.0, last - UNCERTAIN);
        measured_front.fit(&reached, UNCERTAIN)
    });
    // The front runs evenly from Z = 2 to 4.
    let slope = |front: &Series| Some(2.0 / (front.arrival(4.0)? - front.arrival(2.0)?));
    let ratio = slope(&front)
        .zip(slope(&measured_front))
        .map(|(ours, theirs)| ours / theirs);
    let figures = vec![
        Figure::new(FIGURE, percent(best.map(|fit| fit.rms)), "%").bar(Bar::AtMost(3.0)),
        Figure::new("shift", best.map(|fit| fit.shift), "√(a/g)"),
        Figure::new(
            "front, not shifted",
            percent(front.fit(&measured_front, 0.0).map(|fit| fit.rms)),
            "%",
        )
        .bar(Bar::AtMost(5.0)),
        Figure::new(
            "the measured front beside itself, 0.15 √(a/g) later",
            percent(late.map(|fit| fit.rms)),
            "%",
        ),
        Figure::new("speed of the front over the measured one", ratio, ""),
        Figure::new("height at the back wall", 100.0 * Norms::new(heights).l2, "%"),
    ];
    Ok(record(bench, CASE.name, &scene, n, run, figures))
}
