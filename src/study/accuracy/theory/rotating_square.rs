//! Pressure of a square of fluid that begins to turn like a rigid body, without walls or weight (Colagrossi 2005).

use std::f64::consts::PI;

/// Terms of each of the two series.
const TERMS: u32 = 60;

/// p / (ρ ω² L²) at a point of the unit square: ∇²p = 2 ρ ω² with p = 0 around it.
pub fn pressure([x, y]: [f64; 2]) -> f64 {
    let odd = || (0..TERMS).map(|n| f64::from(2 * n + 1) * PI);
    let each = odd().flat_map(|m| odd().map(move |n| (m, n)));
    each.map(|(m, n)| -32.0 / (m * n * (m * m + n * n)) * (m * x).sin() * (n * y).sin())
        .sum()
}
