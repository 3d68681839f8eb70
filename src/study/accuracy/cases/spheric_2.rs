//! A dam that breaks onto a box, in 3D.

use glam::DVec3;

use super::Case;
use super::fluid::{flow, record, shipped, spacing};
use crate::error::Result;
use crate::study::Size;
use crate::study::accuracy::norms::Norms;
use crate::study::accuracy::record::{Bar, Figure, Record};
use crate::study::accuracy::reference;
use crate::study::accuracy::sampler::{Sampler, share};
use crate::study::accuracy::series::Series;
use crate::study::bench::Bench;

pub const CASE: Case = Case {
    name: "spheric_2",
    title: "A dam breaks onto a box",
    about: "Water 0.55 m high runs onto a box in a tank of 3.22 m (scene `spheric_2`; Kleefsman 2005, SPHERIC test 2). \
            Heights are depths of water at the four gauges (volume over area, which is what wires feel that measure how \
            much of them is wet, also in the splash behind the box), compared over the run; those of the highest wet \
            point are given too. Arrival is measured at the lowest pressure sensor on the box, which also gives the peak, and \
            at the two gauges that the front passes on its way: the measured one is far ahead at the first already, so \
            that its clock seems to start after the water does. The time from H2 to the box needs no clock. 30 particles \
            over the height are the benchmark's own spacing, 0.0183 m. Small studies end after 2 s, tiny ones after 0.5 s.",
    resolution: "particles high",
    label: |n| n.to_string(),
    resolutions: |size| match size {
        Size::Tiny => &[6],
        Size::Small => &[10],
        Size::Full => &[15, 22, 30],
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
/// How far they reach up, m.
const REACHED: f64 = 1.0;
/// P1, on the face of the box that the water hits, m.
const SENSOR: DVec3 = DVec3::new(0.8245, 0.021, 0.4745);
/// Pressure that counts as water's arrival, Pa.
const ARRIVED: f64 = 1000.0;
/// Depth of the front that counts at the gauges which it passes before, m.
const PASSED: f64 = 0.02;

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
    let spacing = 2.0 * scene.radius();
    let mut depths = [(); 4].map(|()| Series::default());
    let mut tops = depths.clone();
    // The side of the tank in front of the box.
    let face = DVec3::new(SENSOR.x, domain.0.y, domain.0.z);
    let share = share(SENSOR, 3, spacing, face, domain.1);
    let mut sensor = Series::default();
    let mut lost = 0;
    let run = flow(bench, &scene, |flow| {
        let sampler = Sampler::new(&flow.position, 3, spacing, None);
        let pressure = sampler.on_wall(SENSOR, &flow.pressure, share);
        sensor.push(flow.time, pressure);
        for ((depth, top), x) in depths.iter_mut().zip(&mut tops).zip(GAUGES) {
            let floor = DVec3::new(x, 0.0, 0.5);
            depth.push(flow.time, sampler.depth(floor, REACHED));
            top.push(flow.time, sampler.height(floor, REACHED));
        }
        // Lost is what is beyond the first layer of a wall's particles. The top is open, and what flies up comes back.
        let (min, max) = (domain.0 - 0.5 * spacing, domain.1 + 0.5 * spacing);
        let inside = |p: &DVec3| p.cmpge(min).all() && p.x <= max.x && p.z <= max.z;
        lost = flow.position.iter().filter(|p| !inside(p)).count();
    })?;
    let levels: Vec<Series> = (1..=GAUGES.len())
        .map(|gauge| reference::spheric_2(&format!("H{gauge}")))
        .collect::<Result<_>>()?;
    let centimetres = |gauges: &[Series]| -> Option<Vec<f64>> {
        let pairs = gauges.iter().zip(&levels);
        pairs
            .map(|(ours, theirs)| Some(100.0 * ours.rms_difference(theirs, 0.01, run.simulated)?))
            .collect()
    };
    let over_all = |rms: &Vec<f64>| Norms::new(rms.iter().map(|&rms| (rms, 0.0)));
    let rms = centimetres(&depths);
    let all = rms.as_ref().map(over_all);
    let all_tops = centimetres(&tops).as_ref().map(over_all);
    let measured = reference::spheric_2("P1")?;
    let peak = sensor
        .peak()
        .zip(measured.peak())
        .map(|((_, ours), (_, theirs))| ours / theirs - 1.0);
    let arrival = late(&sensor, &measured, ARRIVED);
    let passing = [0, 1].map(|gauge| late(&depths[gauge], &levels[gauge], PASSED));
    let mut figures = vec![
        Figure::new(HEIGHTS, all.map(|all| all.largest), "cm").bar(Bar::AtMost(3.0)),
        Figure::new("arrival after the measured one", arrival, "ms").bar(Bar::Within(-10.0, 10.0)),
        Figure::new("the front passes H1 after the measured one", passing[0], "ms"),
        Figure::new("the front passes H2 after the measured one", passing[1], "ms"),
        Figure::new(
            "from H2 to the box longer than measured",
            arrival
                .zip(passing[1])
                .map(|(arrival, passing)| arrival - passing),
            "ms",
        ),
        Figure::new(
            "peak of P1 beside the measured one",
            peak.map(|peak| 100.0 * peak),
            "%",
        )
        .bar(Bar::Within(-20.0, 20.0)),
        Figure::new("particles lost", lost as f64, "").bar(Bar::AtMost(0.0)),
        Figure::new("RMS of all gauges", all.map(|all| all.l2), "cm"),
        Figure::new(
            "worst RMS of the highest wet points",
            all_tops.map(|all| all.largest),
            "cm",
        ),
    ];
    for gauge in 0..GAUGES.len() {
        let rms = rms.as_ref().map(|all| all[gauge]);
        figures.push(Figure::new(format!("RMS of H{}", gauge + 1), rms, "cm"));
    }
    Ok(record(bench, CASE.name, &scene, n, run, figures))
}

/// How much later one series reaches a value than another, ms.
fn late(ours: &Series, theirs: &Series, value: f64) -> Option<f64> {
    Some(1000.0 * (ours.arrival(value)? - theirs.arrival(value)?))
}
