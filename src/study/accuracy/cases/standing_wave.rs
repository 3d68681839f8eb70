//! A small wave that stands and dies out.

use std::f64::consts::{PI, TAU};

use super::Case;
use super::fluid::{flow, record, shipped, spacing};
use crate::error::Result;
use crate::study::Size;
use crate::study::accuracy::record::{Bar, Figure, Record};
use crate::study::accuracy::series::Series;
use crate::study::bench::Bench;

pub const CASE: Case = Case {
    name: "standing_wave",
    title: "A standing wave",
    about: "A wave as long as two depths of water stands in a basin that slips below and repeats sideways (scene \
            `standing_wave`, Re = H √(gH) / ν = 250). The velocities' share of the wave of linear theory swings; its zeros \
            give the period beside 2π / √(g k tanh kH), its extremes the rate at which energy decays, beside 0.442 1/s of \
            the viscous mode of this depth. (The bulk alone dissipates 4 ν k² = 0.494 1/s of it; half of that is what \
            ν ∫ |∇u|² would.)",
    resolution: "particles deep",
    label: |n| n.to_string(),
    resolutions: |size| match size {
        Size::Tiny => &[15],
        Size::Small => &[25],
        Size::Full => &[25, 50],
    },
    figure: FIGURE,
    published: &[],
    run: |bench, _, n| Ok(vec![one(bench, n)?]),
};

const FIGURE: &str = "decay of energy";
const WAVELENGTH: f64 = 2.0;
const GRAVITY: f64 = 9.81;
/// 1/s.
const DECAY: f64 = 0.442;

fn one(bench: &Bench, n: u32) -> Result<Record> {
    let scene = shipped(CASE.name, &[spacing(1.0, n)])?;
    let k = TAU / WAVELENGTH;
    let mut swing = Series::default();
    let mut largest = 0.0_f64;
    let run = flow(bench, &scene, |flow| {
        let (mut along, mut norm) = (0.0, 0.0);
        for (at, v) in flow.position.iter().zip(&flow.velocity) {
            let mode = [
                -(k * at.y).cosh() * (k * at.x).sin(),
                (k * at.y).sinh() * (k * at.x).cos(),
            ];
            along += v.x * mode[0] + v.y * mode[1];
            norm += mode[0].powi(2) + mode[1].powi(2);
        }
        swing.push(flow.time, along / norm);
        largest = largest.max(flow.largest_speed());
    })?;
    let (period, decay) = read(&swing);
    let truth = TAU / (GRAVITY * k * k.tanh()).sqrt();
    let judged = |most: f64| (n >= 50).then_some(Bar::Within(-most, most));
    let percent = |value: Option<f64>, truth: f64| value.map(|value| 100.0 * (value / truth - 1.0));
    let figures = vec![
        Figure::new(FIGURE, percent(decay, DECAY), "% off").bar(judged(10.0)),
        Figure::new("period", percent(period, truth), "% off").bar(judged(0.5)),
        Figure::new("decay of energy as found", decay, "1/s"),
        Figure::new("largest speed", largest, "m/s"),
    ];
    Ok(record(bench, CASE.name, &scene, n, run, figures))
}

/// Period, s, and the rate at which the square decays, 1/s, of a swing that starts at an extreme.
fn read(swing: &Series) -> (Option<f64>, Option<f64>) {
    let points: Vec<_> = swing.points().collect();
    let zeros: Vec<f64> = points
        .windows(2)
        .filter(|pair| pair[0].1 * pair[1].1 < 0.0)
        .map(|pair| pair[0].0 + (pair[1].0 - pair[0].0) * pair[0].1 / (pair[0].1 - pair[1].1))
        .collect();
    let period = match zeros[..] {
        [first, .., last] => Some(2.0 * (last - first) / (zeros.len() - 1) as f64),
        _ => None,
    };
    // Of each half wave, the share of its sine: less prone to noise than the highest point.
    let halves: Vec<(f64, f64)> = zeros
        .windows(2)
        .filter_map(|ends| {
            let inside = points.iter().filter(|(t, _)| (ends[0]..ends[1]).contains(t));
            let (mut along, mut norm) = (0.0, 0.0);
            for (t, value) in inside {
                let sine = (PI * (t - ends[0]) / (ends[1] - ends[0])).sin();
                along += value.abs() * sine;
                norm += sine * sine;
            }
            (norm > 0.0).then(|| (0.5 * (ends[0] + ends[1]), (along / norm).ln()))
        })
        .collect();
    let decay = (halves.len() > 1).then(|| {
        let count = halves.len() as f64;
        let [t, y] = [0, 1].map(|k| halves.iter().map(|h| [h.0, h.1][k]).sum::<f64>() / count);
        let slope: f64 = halves.iter().map(|h| (h.0 - t) * (h.1 - y)).sum();
        -2.0 * slope / halves.iter().map(|h| (h.0 - t).powi(2)).sum::<f64>()
    });
    (period, decay)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn period_and_decay_are_read_from_a_swing() {
        let at = |t: f64| (-0.2 * t).exp() * (5.5 * t).cos();
        let swing = Series::new((0..200).map(|n| (0.025 * f64::from(n), at(0.025 * f64::from(n)))));
        let (period, decay) = read(&swing);
        assert!((period.unwrap() * 5.5 / TAU - 1.0).abs() < 1e-3, "{period:?}");
        assert!((decay.unwrap() / 0.4 - 1.0).abs() < 1e-2, "{decay:?}");
        assert_eq!(read(&Series::new([(0.0, 1.0), (1.0, 2.0)])), (None, None));
    }
}
