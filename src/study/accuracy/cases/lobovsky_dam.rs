//! Pressures of a breaking dam at the far wall.

use glam::DVec3;

use super::Case;
use super::fluid::{flow, record, shipped, spacing};
use crate::error::Result;
use crate::gpu::timing::median;
use crate::scene::Scene;
use crate::study::Size;
use crate::study::accuracy::record::{Bar, Figure, Record};
use crate::study::accuracy::reference;
use crate::study::accuracy::run::Run;
use crate::study::accuracy::sampler::{REACH, Sampler, share};
use crate::study::accuracy::series::Series;
use crate::study::bench::Bench;

pub const CASE: Case = Case {
    name: "lobovsky_dam",
    title: "Impact of a breaking dam",
    about: "Water 0.3 m deep runs through a tank of 1.61 m and hits the far wall (scene `lobovsky_dam`; Lobovský 2014). \
            Pressures at the wall are kernel means over the particles within 2.5 spacings of the sensors, with air as \
            zero, averaged over 1 ms. The peak is given twice: as such, and with TrixiParticles' sensor, a mean over the \
            fluid within 8 spacings, since the peak depends on what it is averaged over. Walls slip, with \
            the friction of turbulent water, and particles are shifted, without which those near the floor thin out and \
            clump; a second method has neither, but artificial viscosity. Support and speed of sound are \
            TrixiParticles'. A splash is chaotic: like those of the experiment, figures are medians of several runs (5 in \
            full studies, 3 in small ones), whose particles start up to 0.01 spacings elsewhere. Times count from the \
            arrival at the sensor, since the experiment's gate takes time to open. The plateau is the mean from 0.5 to \
            2 √(H/g) after arrival and the impulse the integral from arrival to 2 √(H/g) after it, both 15 mm above the \
            floor and judged by the same figures of the experiments' 2.5 and 97.5 percentiles.",
    resolution: "particles high",
    label: |n| n.to_string(),
    resolutions: |size| match size {
        Size::Tiny => &[10],
        Size::Small => &[20],
        Size::Full => &[20, 40, 80],
    },
    figure: FIGURE,
    published: &[],
    run: |bench, size, n| {
        METHODS
            .iter()
            .map(|changes| one(bench, size, n, changes))
            .collect()
    },
};

const FIGURE: &str = "peak beside the measured one";
/// Radius of TrixiParticles' sensor, spacings (`interpolate_line` with twice the smoothing length of 2 spacings).
const PEER_REACH: f64 = 8.0;
/// As the scene is, and as most solvers do: no shifting, no friction, artificial viscosity.
const METHODS: [&[&str]; 2] = [
    &[],
    &[
        "fluid.shifting=0",
        "fluid.wall_friction=0",
        "fluid.artificial_viscosity=0.01",
    ],
];
/// What the particles' first places differ by from run to run, spacings.
const JITTER: f64 = 0.01;
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

/// What the wall felt in one run, times in √(H/g) and pressures in ρgH, means over 1 ms.
struct Blow {
    /// At the two sensors.
    low: Series,
    middle: Series,
    /// At the lower one, as TrixiParticles measures it.
    wide: Series,
}

fn one(bench: &Bench, size: Size, n: u32, changes: &[&str]) -> Result<Record> {
    let seeds = match size {
        Size::Tiny => 1,
        Size::Small => 3,
        Size::Full => 5,
    };
    let scene = |seed: u32| {
        let mut overrides = vec![
            spacing(H, n),
            "time.duration=1".to_owned(),
            format!("time.fps={SAMPLED}"),
            format!("seed={seed}"),
            format!("bodies[0].jitter={JITTER}"),
        ];
        overrides.extend(changes.iter().map(|&change| change.to_owned()));
        shipped(CASE.name, &overrides)
    };
    let all: Vec<_> = (1..=seeds)
        .map(|seed| felt(bench, &scene(seed)?, n))
        .collect::<Result<_>>()?;
    let (runs, blows): (Vec<_>, Vec<_>) = all.into_iter().unzip();
    let run = runs.into_iter().reduce(Run::with).expect("a run");
    let measured = reference::lobovsky()?;
    let [least, middle, most] = &measured.band;
    let beside = |peak: f64| {
        let theirs = measured.sensors[0].peak().map(|(_, theirs)| theirs);
        theirs.map(|theirs| 100.0 * (peak / theirs - 1.0))
    };
    let peak = |of: &Series| of.peak().and_then(|(_, ours)| beside(ours));
    let of = |value: &dyn Fn(&Blow) -> Option<f64>| Spread::of(blows.iter().map(value));
    let peaks = of(&|blow| peak(&blow.low));
    let wide = of(&|blow| peak(&blow.wide));
    let plateaus = of(&|blow| plateau(&blow.middle));
    let impulses = of(&|blow| impulse(&blow.middle));
    let arrivals = of(&|blow| blow.middle.arrival(ARRIVED));
    let within = |of: fn(&Series) -> Option<f64>| match (of(least), of(most)) {
        (Some(least), Some(most)) => Some(Bar::Within(least, most)),
        _ => None,
    };
    let mut figures = vec![
        Figure::new(FIGURE, peaks.median, "%").bar(Bar::Within(-15.0, 15.0)),
        Figure::new(
            "peak beside the measured one, TrixiParticles' sensor",
            wide.median,
            "%",
        )
        .bar(Bar::Within(-15.0, 15.0))
        .best(-1.4, "TrixiParticles, 40 high (14.1 at 80, 7.7 at 400)"),
        Figure::new("plateau", plateaus.median, "ρgH").bar(within(plateau)),
        Figure::new("impulse", impulses.median, "ρgH √(H/g)").bar(within(impulse)),
        Figure::new("arrival", arrivals.median, "√(H/g)"),
        Figure::new(
            "arrival in the experiment (median)",
            middle.arrival(ARRIVED),
            "√(H/g)",
        ),
    ];
    if seeds > 1 {
        let spreads = [
            ("peak", peaks, "%"),
            ("plateau", plateaus, "ρgH"),
            ("impulse", impulses, "ρgH √(H/g)"),
        ];
        for (name, spread, unit) in spreads {
            figures.push(Figure::new(
                format!("{name}, lowest of {seeds} runs"),
                spread.least,
                unit,
            ));
            figures.push(Figure::new(
                format!("{name}, highest of {seeds} runs"),
                spread.most,
                unit,
            ));
        }
    }
    Ok(record(bench, CASE.name, &scene(1)?, n, run, figures))
}

/// Name of the figure of [`arrival`].
pub const ARRIVAL: &str = "arrival beside the measured one";

/// The case's scene up to the water's arrival at the far wall, with other keys changed.
pub fn arrival_scene(n: u32, changes: &[String]) -> Result<Scene> {
    let of_case = [
        spacing(H, n),
        "time.duration=0.52".to_owned(),
        "time.fps=1000".to_owned(),
    ];
    shipped(CASE.name, &[&of_case, changes].concat())
}

/// The record of one run up to there, whose figure is how much later water arrives at the middle sensor than in the
/// experiment, percent.
pub fn arrival(bench: &Bench, n: u32, changes: &[String]) -> Result<Record> {
    let scene = arrival_scene(n, changes)?;
    let (run, blow) = felt(bench, &scene, n)?;
    let measured = reference::lobovsky()?.band[1].arrival(ARRIVED);
    let late = blow.middle.arrival(ARRIVED).zip(measured);
    let figure = Figure::new(
        ARRIVAL,
        late.map(|(ours, theirs)| 100.0 * (ours / theirs - 1.0)),
        "%",
    );
    Ok(record(bench, CASE.name, &scene, n, run, vec![figure]))
}

fn felt(bench: &Bench, scene: &Scene, n: u32) -> Result<(Run, Blow)> {
    let unit = (H / GRAVITY).sqrt();
    let spacing = H / f64::from(n);
    let places = HEIGHTS.map(|height| DVec3::new(WALL, height, 0.0));
    let tank = DVec3::new(WALL, 1.0, 0.0);
    let shares = places.map(|at| share(at, 2, spacing, DVec3::ZERO, tank));
    let [mut low, mut middle, mut wide] = [(); 3].map(|()| Series::default());
    let run = flow(bench, scene, |flow| {
        let time = flow.time / unit;
        let near = Sampler::new(&flow.position, 2, spacing, None);
        for ((series, at), share) in [&mut low, &mut middle].into_iter().zip(places).zip(shares) {
            let p = near.on_wall(at, &flow.pressure, share);
            series.push(time, p / (DENSITY * GRAVITY * H));
        }
        let around = Sampler::new(&flow.position, 2, spacing * PEER_REACH / REACH, None);
        let p = around.on_wall(places[0], &flow.pressure, f64::MIN_POSITIVE);
        wide.push(time, p.max(0.0) / (DENSITY * GRAVITY * H));
    })?;
    let [low, middle, wide] = [low, middle, wide].map(|series| series.moving_average(AVERAGED / unit));
    Ok((run, Blow { low, middle, wide }))
}

/// Of one figure over several runs; none where a run lacks it.
#[derive(Clone, Copy)]
struct Spread {
    least: Option<f64>,
    median: Option<f64>,
    most: Option<f64>,
}

impl Spread {
    fn of(values: impl Iterator<Item = Option<f64>>) -> Self {
        let values: Option<Vec<f64>> = values.collect();
        let pick =
            |from: fn(f64, f64) -> f64| values.as_ref().and_then(|all| all.iter().copied().reduce(from));
        Self {
            least: pick(f64::min),
            median: values.clone().map(median),
            most: pick(f64::max),
        }
    }
}

fn plateau(pressure: &Series) -> Option<f64> {
    let arrival = pressure.arrival(ARRIVED)?;
    pressure.mean(arrival + PLATEAU[0], arrival + PLATEAU[1])
}

fn impulse(pressure: &Series) -> Option<f64> {
    let arrival = pressure.arrival(ARRIVED)?;
    pressure.integral(arrival, arrival + PLATEAU[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_told_by_their_median_and_ends() {
        let of = |values: &[Option<f64>]| {
            let spread = Spread::of(values.iter().copied());
            (spread.least, spread.median, spread.most)
        };
        let odd = of(&[Some(3.0), Some(-1.0), Some(90.0)]);
        assert_eq!(odd, (Some(-1.0), Some(3.0), Some(90.0)));
        assert_eq!(of(&[Some(4.0), Some(2.0)]), (Some(2.0), Some(3.0), Some(4.0)));
        // A run whose water never arrived must not be passed over.
        assert_eq!(of(&[Some(3.0), None, Some(90.0)]), (None, None, None));
    }
}
