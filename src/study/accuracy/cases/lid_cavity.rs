//! A cavity whose lid slides.

use glam::DVec3;

use super::Case;
use super::fluid::{Flow, flow, record, shipped, spacing};
use crate::error::Result;
use crate::study::Size;
use crate::study::accuracy::norms::Norms;
use crate::study::accuracy::record::{Bar, Figure, Record};
use crate::study::accuracy::reference;
use crate::study::accuracy::sampler::Sampler;
use crate::study::accuracy::series::Series;
use crate::study::bench::Bench;

pub const RE_100: Case = Case {
    name: "lid_cavity",
    title: "Lid-driven cavity, Re 100",
    run: |bench, size, n| Ok(vec![one(bench, size, RE_100.name, 100, n)?]),
    ..CAVITY
};

pub const RE_400: Case = Case {
    name: "lid_cavity_400",
    title: "Lid-driven cavity, Re 400",
    run: |bench, size, n| Ok(vec![one(bench, size, RE_400.name, 400, n)?]),
    ..CAVITY
};

const CAVITY: Case = Case {
    name: "",
    title: "",
    about: "The lid of a square cavity slides until the flow is steady (scene `lid_cavity`, the set-up of Ghia 1982). u \
            on the vertical and v on the horizontal center line, averaged over the last second, are compared with a \
            solution on a fine grid (error at most 2e-5; the 1982 table has misprints). The figure is the root of the \
            mean square of all differences, over the lid's speed.",
    resolution: "particles across",
    label: |n| format!("{n}²"),
    resolutions: |size| match size {
        Size::Tiny => &[15],
        Size::Small => &[25],
        Size::Full => &[25, 50, 100],
    },
    figure: FIGURE,
    published: &[],
    run: |_, _, _| Ok(Vec::new()),
};

const FIGURE: &str = "RMS on the center lines";

fn one(bench: &Bench, size: Size, case: &str, reynolds: u32, n: u32) -> Result<Record> {
    // Seconds until the flow changes by less than 1e-3; in tiny studies it still does.
    let duration = match (size, reynolds) {
        (Size::Tiny, _) => 3.0,
        (_, 100) => 15.0,
        _ => 40.0,
    };
    let overrides = [
        spacing(1.0, n),
        format!("fluid.viscosity={}", 1.0 / f64::from(reynolds)),
        format!("time.duration={duration}"),
    ];
    let scene = shipped("lid_cavity", &overrides)?;
    let truth = reference::cavity(reynolds)?;
    let [us, vs] = truth.each_ref().map(inner_points);
    let (mut sums, mut moments) = (vec![0.0; us.len() + vs.len()], 0.0);
    let run = flow(bench, &scene, |flow| {
        if flow.time > duration - 1.0 {
            let found = center_lines(flow, 1.0 / f64::from(n), &us, &vs);
            sums.iter_mut().zip(found).for_each(|(sum, value)| *sum += value);
            moments += 1.0;
        }
    })?;
    let found = sums.iter().map(|sum| sum / moments);
    let expected = us.iter().chain(&vs).map(|(_, value)| *value);
    let norms = Norms::new(found.zip(expected));
    let figures = vec![
        Figure::new(FIGURE, 100.0 * norms.l2, "%").bar((n >= 100).then_some(Bar::AtMost(1.0))),
        Figure::new("largest error on the center lines", 100.0 * norms.largest, "%"),
    ];
    Ok(record(bench, case, &scene, n, run, figures))
}

/// Without the ends, which are the walls' own speeds.
fn inner_points(series: &Series) -> Vec<(f64, f64)> {
    series
        .points()
        .filter(|(s, _)| (1e-9..1.0 - 1e-9).contains(s))
        .collect()
}

fn center_lines(flow: &Flow, spacing: f64, us: &[(f64, f64)], vs: &[(f64, f64)]) -> Vec<f64> {
    let sampler = Sampler::new(&flow.position, 2, spacing, None);
    let at = |x: f64, y: f64| {
        let found = sampler.vector(DVec3::new(x, y, 0.0), &flow.velocity);
        found.unwrap_or(DVec3::NAN)
    };
    let u = us.iter().map(|&(y, _)| at(0.5, y).x);
    u.chain(vs.iter().map(|&(x, _)| at(x, 0.5).y)).collect()
}
