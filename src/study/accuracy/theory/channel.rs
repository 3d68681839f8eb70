//! Flow between two plates that starts from rest: Morris, Fox and Zhu 1997, Eq. 21 and 22.
//!
//! Heights η = y/d from 0 to 1, times T = ν t / d².

use std::f64::consts::PI;

/// Terms below this share of the whole are left out.
const SMALLEST_EXPONENT: f64 = -45.0;

/// Poiseuille flow under a body force F: u/u_max, where u_max = F d² / (8 ν) is the speed at the middle in the end.
pub fn poiseuille(eta: f64, time: f64) -> f64 {
    if time <= 0.0 {
        return 0.0;
    }
    let decaying = terms(time, 1, 2)
        .map(|(k, decay)| 32.0 / (PI * k).powi(3) * (PI * k * eta).sin() * decay)
        .sum::<f64>();
    4.0 * eta * (1.0 - eta) - decaying
}

/// Couette flow, whose plate at η = 1 moves with V from T = 0 on: u/V.
pub fn couette(eta: f64, time: f64) -> f64 {
    if time <= 0.0 {
        return if eta >= 1.0 { 1.0 } else { 0.0 };
    }
    let decaying = terms(time, 1, 1)
        .map(|(k, decay)| {
            let sign = (-1.0_f64).powi(k as i32);
            2.0 * sign / (PI * k) * (PI * k * eta).sin() * decay
        })
        .sum::<f64>();
    eta + decaying
}

/// k = first, first + step, … with exp(−k² π² T), as long as that matters.
fn terms(time: f64, first: usize, step: usize) -> impl Iterator<Item = (f64, f64)> {
    (first..).step_by(step).map_while(move |k| {
        let k = k as f64;
        let exponent = -(k * PI).powi(2) * time;
        (exponent > SMALLEST_EXPONENT).then(|| (k, exponent.exp()))
    })
}
