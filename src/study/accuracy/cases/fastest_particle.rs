//! How fast single particles of a dam break become.

use super::Case;
use super::fluid::{flow, record, shipped, spacing};
use crate::error::Result;
use crate::study::Size;
use crate::study::accuracy::record::{Bar, Figure, Record};
use crate::study::bench::Bench;

pub const CASE: Case = Case {
    name: "fastest_particle",
    title: "The fastest particle of a dam break",
    about: "A column of water, H = 0.5 m high, runs over a floor and meets a wall (scene `dam_break_2d`, up to 0.6 s). Ritter's \
            front runs at 2 √(gH), so nothing should be faster before water meets the wall; afterwards the jet that runs up \
            the wall is faster than what feeds it. Told are the fastest particles before and after, when the latter was \
            seen, and where.",
    resolution: "particles high",
    label: |n| n.to_string(),
    resolutions: |size| match size {
        Size::Tiny => &[16],
        Size::Small => &[32],
        Size::Full => &[32, 64],
    },
    figure: FIGURE,
    published: &[],
    run: |bench, _, n| Ok(vec![one(bench, n)?]),
};

const FIGURE: &str = "fastest before the wall";
const HEIGHT: f64 = 0.5;
const GRAVITY: f64 = 9.81;
/// Where the far wall stands, m.
const WALL: f64 = 1.0;

fn one(bench: &Bench, n: u32) -> Result<Record> {
    let overrides = [
        spacing(HEIGHT, n),
        "time.duration=0.6".into(),
        "time.fps=100".into(),
    ];
    let scene = shipped("dam_break_2d", &overrides)?;
    let spacing = HEIGHT / f64::from(n);
    let unit = (GRAVITY * HEIGHT).sqrt();
    let (mut met, mut before) = (false, 0.0_f64);
    // Speed, time, and place of the fastest afterwards.
    let mut after = (0.0, 0.0, glam::DVec3::ZERO);
    let run = flow(bench, &scene, |flow| {
        met = met || flow.position.iter().any(|at| at.x > WALL - 2.0 * spacing);
        for (at, v) in flow.position.iter().zip(&flow.velocity) {
            let speed = v.length() / unit;
            if !met {
                before = before.max(speed);
            } else if speed > after.0 {
                after = (speed, flow.time, *at);
            }
        }
    })?;
    let figures = vec![
        Figure::new(FIGURE, before, "√(gH)").bar(Bar::AtMost(2.1)),
        Figure::new("fastest afterwards", after.0, "√(gH)"),
        Figure::new("when", after.1 * unit / HEIGHT, "√(H/g)"),
        Figure::new(
            "its distance from the wall",
            (WALL - after.2.x) / spacing,
            "spacings",
        ),
        Figure::new("its height", after.2.y / HEIGHT, "H"),
    ];
    Ok(record(bench, CASE.name, &scene, n, run, figures))
}
