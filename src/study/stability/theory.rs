//! Longest stable steps, by linear theory.

use std::f64::consts::PI;

use crate::physics::kernels;
use crate::scene::fluid::Fluid;

/// Points of the zone of wave vectors along each axis.
const WAVES: u32 = 64;

/// Of sound in an inviscid fluid at rest on a square lattice, seconds.
///
/// A displacement u changes densities by ρ V Σ (uᵢ − uⱼ)·∇W and these the acceleration by −c² V Σ δρⱼ/ρ ∇W, so a wave
/// with wave vector k has ω² = c² D(k)·P(k), where D and P are V Σ ∇W(r) sin(k·r) with the kernel of density and that of
/// pressure. Symplectic Euler is stable up to ω Δt = 2.
pub fn sound_limit(fluid: &Fluid) -> f64 {
    let s = fluid.spacing;
    let h = fluid.smoothing();
    let reach = (fluid.support / s).ceil() as i32;
    let mut offsets = Vec::new();
    for x in -reach..=reach {
        for y in -reach..=reach {
            let offset = [f64::from(x) * s, f64::from(y) * s];
            let r = offset[0].hypot(offset[1]);
            if r > 0.0 && r < fluid.support {
                // Müller's density has a kernel of its own.
                let tiny = 1e-6 * h;
                let density = (kernels::value(fluid.kernel, 2, h, r + tiny)
                    - kernels::value(fluid.kernel, 2, h, r - tiny))
                    / (2.0 * tiny);
                let pressure = kernels::slope(fluid.kernel, 2, h, r);
                offsets.push((offset, density * s * s / r, pressure * s * s / r));
            }
        }
    }
    let mut fastest: f64 = 0.0;
    for a in 0..=WAVES {
        for b in 0..=a {
            let k = [a, b].map(|n| PI / s * f64::from(n) / f64::from(WAVES));
            let (mut d, mut p) = ([0.0; 2], [0.0; 2]);
            for (offset, density, pressure) in &offsets {
                let sine = (k[0] * offset[0] + k[1] * offset[1]).sin();
                for axis in 0..2 {
                    d[axis] += density * offset[axis] * sine;
                    p[axis] += pressure * offset[axis] * sine;
                }
            }
            fastest = fastest.max(d[0] * p[0] + d[1] * p[1]);
        }
    }
    2.0 / (fluid.sound_speed * fastest.sqrt())
}

/// Of a column of grains on the floor, seconds: its fastest mode has ω = 2 √(k/m) cos(π / (2 n + 1)), and damping
/// ζ = η ω / (2 k). Symplectic Euler with the damping of the velocity before is stable up to ω Δt = 2 (√(1 + ζ²) − ζ).
pub fn column_limit(spring: f64, damping: f64, mass: f64, grains: u32) -> f64 {
    let omega = 2.0 * (spring / mass).sqrt() * (PI / f64::from(2 * grains + 1)).cos();
    let zeta = damping * omega / (2.0 * spring);
    2.0 * ((1.0 + zeta * zeta).sqrt() - zeta) / omega
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn undamped_grains_take_two_over_omega() {
        // One grain on the floor: ω² = k/m. Of two, ω² = (3 + √5)/2 k/m is the greater one.
        assert!((column_limit(4.0, 0.0, 1.0, 1) - 1.0).abs() < 1e-12);
        let two = ((3.0 + 5f64.sqrt()) / 2.0).sqrt();
        assert!((column_limit(1.0, 0.0, 1.0, 2) - 2.0 / two).abs() < 1e-12);
        let long = column_limit(1.0, 0.0, 1.0, 10_000);
        assert!((long - 1.0).abs() < 1e-6, "{long}");
        assert!(column_limit(1.0, 0.1, 1.0, 8) < column_limit(1.0, 0.0, 1.0, 8));
    }
}
