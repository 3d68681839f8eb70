//! Pressures of a breaking dam at the far wall.

use glam::DVec3;

use super::Case;
use super::fluid::{flow, record, shipped, spacing};
use crate::error::Result;
use crate::study::Size;
use crate::study::accuracy::record::{Bar, Figure, Record};
use crate::study::accuracy::reference;
use crate::study::accuracy::sampler::{REACH, Sampler, share};
use crate::study::accuracy::series::Series;
use crate::study::bench::Bench;

pub const CASE: Case = Case {
    name: "lobovsky_dam",
    title: "Impact of a breaking dam",
    about: "Water 0.3 m deep runs through a tank of 1.61 m and hits the far wall (scene `lobovsky_dam`; Lobovský 2014). \
            Pressures at the wall are kernel means over the particles within 2.5 spacings of the sensors, with air as \
            zero, averaged over 1 ms. The peak is told twice: so, and with TrixiParticles' sensor, a mean over the \
            fluid within 8 spacings, since the peak depends on what it is averaged over. Walls slip, \
            with support and speed of sound as TrixiParticles has them; a second method has walls that stick, which \
            slow the front and pile it up. Times count \
            from the arrival at the sensor, since the experiment's gate takes time to open. The plateau is the mean \
            from 0.5 to 2 √(H/g) after arrival and the impulse the integral from arrival to 2 √(H/g) after it, both \
            15 mm above the floor and judged by the same figures of the experiments' 2.5 and 97.5 percentiles.",
    resolution: "particles high",
    label: |n| n.to_string(),
    resolutions: |size| match size {
        Size::Tiny => &[10],
        Size::Small => &[20],
        Size::Full => &[20, 40, 80],
    },
    figure: FIGURE,
    published: &[],
    run: |bench, _, n| METHODS.iter().map(|changes| one(bench, n, changes)).collect(),
};

const FIGURE: &str = "peak beside the measured one";
/// Radius of TrixiParticles' sensor, spacings (`interpolate_line` with twice the smoothing length of 2 spacings).
const PEER_REACH: f64 = 8.0;
/// Without friction at the walls, and with walls that the fluid and its artificial viscosity stick to.
const METHODS: [&[&str]; 2] = [
    &[],
    &["fluid.slip=no_slip", "fluid.support=3", "fluid.sound_speed=24.3"],
];
/// Depth of the water, m.
const H: f64 = 0.3;
const GRAVITY: f64 = 9.81;
const DENSITY: f64 = 997.0;
/// Where the sensors are, m.
const WALL: f64 = 1.61;
const HEIGHTS: [f64; 2] = [0.003, 0.015];
/// Frames a second: a particle's blow must not fall between two of them, or the mean would depend on luck.
const SAMPLED: u32 = 10_000;
/// s.
const AVERAGED: f64 = 1e-3;
/// Pressure that counts as water's arrival, ρgH.
const ARRIVED: f64 = 0.1;
/// Of the plateau after arrival, √(H/g).
const PLATEAU: [f64; 2] = [0.5, 2.0];

fn one(bench: &Bench, n: u32, changes: &[&str]) -> Result<Record> {
    let mut overrides = vec![
        spacing(H, n),
        "time.duration=1".to_owned(),
        format!("time.fps={SAMPLED}"),
    ];
    overrides.extend(changes.iter().map(|&change| change.to_owned()));
    let scene = shipped(CASE.name, &overrides)?;
    let unit = (H / GRAVITY).sqrt();
    let places = HEIGHTS.map(|height| DVec3::new(WALL, height, 0.0));
    let tank = DVec3::new(WALL, 1.0, 0.0);
    let shares = places.map(|at| share(at, 2, H / f64::from(n), DVec3::ZERO, tank));
    let mut sensors = [Series::default(), Series::default()];
    let mut wide = Series::default();
    let run = flow(bench, &scene, |flow| {
        let sampler = Sampler::new(&flow.position, 2, H / f64::from(n), None);
        for ((series, at), share) in sensors.iter_mut().zip(places).zip(shares) {
            let p = sampler.on_wall(at, &flow.pressure, share);
            series.push(flow.time / unit, p / (DENSITY * GRAVITY * H));
        }
        let sampler = Sampler::new(&flow.position, 2, H / f64::from(n) * PEER_REACH / REACH, None);
        let p = sampler.on_wall(places[0], &flow.pressure, f64::MIN_POSITIVE);
        wide.push(flow.time / unit, p.max(0.0) / (DENSITY * GRAVITY * H));
    })?;
    let [low, middle] = sensors.map(|series| series.moving_average(AVERAGED / unit));
    let measured = reference::lobovsky()?;
    let [least, median, most] = &measured.band;
    let wide = wide.moving_average(AVERAGED / unit);
    let peak = |of: &Series| {
        let peaks = of.peak().zip(measured.sensors[0].peak());
        peaks.map(|((_, ours), (_, theirs))| 100.0 * (ours / theirs - 1.0))
    };
    let within = |of: fn(&Series) -> Option<f64>| match (of(least), of(most)) {
        (Some(least), Some(most)) => Some(Bar::Within(least, most)),
        _ => None,
    };
    let figures = vec![
        Figure::new(FIGURE, peak(&low), "%").bar(Bar::Within(-15.0, 15.0)),
        Figure::new(
            "peak beside the measured one, TrixiParticles' sensor",
            peak(&wide),
            "%",
        )
        .bar(Bar::Within(-15.0, 15.0))
        .best(-1.4, "TrixiParticles, 40 high (14.1 at 80, 7.7 at 400)"),
        Figure::new("plateau", plateau(&middle), "ρgH").bar(within(plateau)),
        Figure::new("impulse", impulse(&middle), "ρgH √(H/g)").bar(within(impulse)),
        Figure::new("arrival", middle.arrival(ARRIVED), "√(H/g)"),
        Figure::new(
            "arrival in the experiment (median)",
            median.arrival(ARRIVED),
            "√(H/g)",
        ),
    ];
    Ok(record(bench, CASE.name, &scene, n, run, figures))
}

fn plateau(pressure: &Series) -> Option<f64> {
    let arrival = pressure.arrival(ARRIVED)?;
    pressure.mean(arrival + PLATEAU[0], arrival + PLATEAU[1])
}

fn impulse(pressure: &Series) -> Option<f64> {
    let arrival = pressure.arrival(ARRIVED)?;
    pressure.integral(arrival, arrival + PLATEAU[1])
}
