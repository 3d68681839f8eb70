//! A dam that breaks onto a box, in 3D.

use glam::DVec3;

use super::Case;
use super::fluid::{flow, record, shipped, spacing};
use crate::error::Result;
use crate::study::Size;
use crate::study::accuracy::record::{Bar, Figure, Record};
use crate::study::accuracy::reference;
use crate::study::accuracy::sampler::{Sampler, share};
use crate::study::accuracy::series::Series;
use crate::study::bench::Bench;

pub const CASE: Case = Case {
    name: "spheric_2",
    title: "A dam breaks onto a box",
    about: "Water 0.55 m high runs onto a box in a tank of 3.22 m (scene `spheric_2`; Kleefsman 2005, SPHERIC test 2). \
            Heights are those of the water's surface at the four gauges, compared over the run; the pressure is that at \
            the lowest sensor on the box. 30 particles over the height are the benchmark's own spacing, 0.0183 m. \
            Small studies end after 2 s.",
    resolution: "particles high",
    label: |n| n.to_string(),
    resolutions: |size| match size {
        Size::Tiny => &[6],
        Size::Small => &[10],
        Size::Full => &[15, 30],
    },
    figure: HEIGHTS,
    published: &[],
    run: |bench, size, n| Ok(vec![one(bench, size, n)?]),
};

const HEIGHTS: &str = "worst RMS of heights";
/// Depth of the water, m.
const H: f64 = 0.55;
/// Gauges H1 to H4: x, m; z is the middle.
/// H1 is the one that the wave meets first, H4 stands in the water at the start.
const GAUGES: [f64; 4] = [1.488, 0.992, 0.496, 2.638];
/// P1, on the face of the box that the water hits, m.
const SENSOR: DVec3 = DVec3::new(0.8245, 0.021, 0.4745);
/// Pressure that counts as water's arrival, Pa.
const ARRIVED: f64 = 1000.0;

fn one(bench: &Bench, size: Size, n: u32) -> Result<Record> {
    let duration = match size {
        Size::Tiny => 0.5,
        Size::Small => 2.0,
        Size::Full => 6.0,
    };
    let overrides = [
        spacing(H, n),
        format!("time.duration={duration}"),
        "time.fps=200".to_owned(),
    ];
    let scene = shipped(CASE.name, &overrides)?;
    let domain = (
        scene.domain.min.as_dvec3() + scene.origin,
        scene.domain.max.as_dvec3() + scene.origin,
    );
    let spacing = H / f64::from(n);
    let mut gauges = [(); 4].map(|()| Series::default());
    // The side of the tank in front of the box.
    let face = DVec3::new(SENSOR.x, domain.0.y, domain.0.z);
    let share = share(SENSOR, 3, spacing, face, domain.1);
    let mut sensor = Series::default();
    let mut lost = 0;
    let run = flow(bench, &scene, |flow| {
        let sampler = Sampler::new(&flow.position, 3, spacing, None);
        let pressure = sampler.on_wall(SENSOR, &flow.pressure, share);
        sensor.push(flow.time, pressure);
        for (series, x) in gauges.iter_mut().zip(GAUGES) {
            series.push(flow.time, sampler.height(DVec3::new(x, 0.0, 0.5), 1.0));
        }
        // Lost is what is beyond the first layer of a wall's particles. The top is open, and what flies up comes back.
        let (min, max) = (domain.0 - 0.5 * spacing, domain.1 + 0.5 * spacing);
        let inside = |p: &DVec3| p.cmpge(min).all() && p.x <= max.x && p.z <= max.z;
        lost = flow.position.iter().filter(|p| !inside(p)).count();
    })?;
    let mut worst = Some(0.0_f64);
    let mut figures = Vec::new();
    for (index, gauge) in gauges.iter().enumerate() {
        let measured = reference::spheric_2(&format!("H{}", index + 1))?;
        let until = measured
            .points()
            .map(|(t, _)| t)
            .take_while(|&t| t <= run.simulated)
            .last();
        let rms = until.and_then(|until| gauge.rms_difference(&measured, 0.01, until));
        worst = worst.zip(rms).map(|(worst, rms)| worst.max(rms));
        figures.push(Figure::new(
            format!("RMS of H{}", index + 1),
            rms.map(|rms| 100.0 * rms),
            "cm",
        ));
    }
    let measured = reference::spheric_2("P1")?;
    let late = sensor
        .arrival(ARRIVED)
        .zip(measured.arrival(ARRIVED))
        .map(|(ours, theirs)| ours - theirs);
    let peak = sensor
        .peak()
        .zip(measured.peak())
        .map(|((_, ours), (_, theirs))| ours / theirs - 1.0);
    figures.splice(
        0..0,
        [
            Figure::new(HEIGHTS, worst.map(|worst| 100.0 * worst), "cm").bar(Bar::AtMost(3.0)),
            Figure::new(
                "arrival after the measured one",
                late.map(|late| 1000.0 * late),
                "ms",
            )
            .bar(Bar::Within(-10.0, 10.0)),
            Figure::new(
                "peak of P1 beside the measured one",
                peak.map(|peak| 100.0 * peak),
                "%",
            )
            .bar(Bar::Within(-20.0, 20.0)),
            Figure::new("particles lost", lost as f64, "").bar(Bar::AtMost(0.0)),
        ],
    );
    Ok(record(bench, CASE.name, &scene, n, run, figures))
}
