//! Taylor–Green vortices in a periodic cube, which become turbulent at higher Reynolds numbers than this one.

use super::Case;
use super::fluid::{flow, record, shipped, spacing};
use crate::error::Result;
use crate::study::Size;
use crate::study::accuracy::record::{Bar, Figure, Record};
use crate::study::accuracy::reference;
use crate::study::accuracy::series::Series;
use crate::study::bench::Bench;

pub const CASE: Case = Case {
    name: "taylor_green_3d",
    title: "Taylor–Green vortices in 3D, Re 100",
    about: "Vortices in a periodic cube of side 2π (scene `taylor_green_3d`, t = 10). The figure is the largest \
            difference of the mean kinetic energy from a reference solution's, over that at the start, 1/8.",
    resolution: "particles across",
    label: |n| format!("{n}³"),
    resolutions: |size| match size {
        Size::Tiny => &[8],
        Size::Small => &[16],
        Size::Full => &[16, 32, 64],
    },
    figure: FIGURE,
    published: &[],
    run: |bench, _, n| Ok(vec![one(bench, n)?]),
};

const FIGURE: &str = "worst of energy";
const START: f64 = 0.125;
/// A little less than the scene's side 2π, m, so that as many particles as wanted fit in.
const SIDE: f64 = 6.283185306;

fn one(bench: &Bench, n: u32) -> Result<Record> {
    let scene = shipped(CASE.name, &[spacing(SIDE, n), "time.fps=10".to_owned()])?;
    let mut energy = Series::default();
    let run = flow(bench, &scene, |flow| {
        let sum: f64 = flow.velocity.iter().map(|v| 0.5 * v.length_squared()).sum();
        energy.push(flow.time, sum / flow.velocity.len() as f64);
    })?;
    let [dissipation, truth] = reference::taylor_green_3d()?;
    let off = truth
        .points()
        .filter_map(|(t, e)| Some((energy.at(t)? - e).abs() / START));
    let worst = off.fold(f64::NAN, f64::max);
    // Over half a second at each side of the peak.
    let most = dissipation.peak().map(|(_, most)| most);
    let rate = dissipation
        .peak()
        .and_then(|(t, _)| Some(energy.at(t - 0.5)? - energy.at(t + 0.5)?));
    let figures = vec![
        Figure::new(FIGURE, 100.0 * worst, "%").bar((n >= 64).then_some(Bar::AtMost(2.0))),
        Figure::new("dissipation around its peak", rate, ""),
        Figure::new("dissipation of the reference there", most, ""),
    ];
    Ok(record(bench, CASE.name, &scene, n, run, figures))
}
