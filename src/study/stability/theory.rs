//! Longest stable steps, by linear theory.

use std::f64::consts::PI;

use crate::physics::kernels;
use crate::scene::fluid::Fluid;

/// Points of the zone of wave vectors along each axis.
const WAVES: u32 = 64;

/// Of sound in an inviscid fluid at rest on a square lattice, whose density may diffuse, seconds.
///
/// A displacement u changes densities by ρ V Σ (uᵢ − uⱼ)·∇W and these the acceleration by −c² V Σ δρⱼ/ρ ∇W, so a wave
/// with wave vector k has ω² = c² D(k)·P(k), where D and P are V Σ ∇W(r) sin(k·r) with the kernel of density and that of
/// pressure. Its density decays at λ = 2 δ h c V Σ |dW/dr| / r (1 − cos k·r), with h half of the support. Symplectic Euler is
/// stable up to (ω Δt)² + 2 λ Δt = 4.
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
    let sound = fluid.sound_speed;
    let diffusion = fluid.density_diffusion * fluid.support * sound;
    let mut shortest = f64::INFINITY;
    for a in 0..=WAVES {
        for b in 0..=a {
            let k = [a, b].map(|n| PI / s * f64::from(n) / f64::from(WAVES));
            let (mut d, mut p, mut lambda) = ([0.0; 2], [0.0; 2], 0.0);
            for (offset, density, pressure) in &offsets {
                let (sine, cosine) = (k[0] * offset[0] + k[1] * offset[1]).sin_cos();
                lambda -= diffusion * density * (1.0 - cosine);
                for axis in 0..2 {
                    d[axis] += density * offset[axis] * sine;
                    p[axis] += pressure * offset[axis] * sine;
                }
            }
            // The positive root, in a form that holds for ω = 0.
            let square = sound * sound * (d[0] * p[0] + d[1] * p[1]).max(0.0);
            shortest = shortest.min(4.0 / (lambda + (lambda * lambda + 4.0 * square).sqrt()));
        }
    }
    shortest
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
    use crate::study::stability::methods::{METHODS, block};

    fn fluid(change: impl FnOnce(&mut serde_json::Value)) -> Fluid {
        let scene = METHODS[1].scene(block([0.0; 2], 8, 8), |file| change(&mut file["fluid"]));
        scene.unwrap().fluid().unwrap().clone()
    }

    /// Worked out with another program: ω = 0.751 c/Δx for the fastest wave at three spacings, and with diffusion 2.344 Δx/c.
    #[test]
    fn sound_waves_on_a_lattice_have_these_limits() {
        for (diffusion, steps) in [(0.0, 2.664), (0.1, 2.344)] {
            let fluid = fluid(|file| file["density_diffusion"] = diffusion.into());
            let found = sound_limit(&fluid) * fluid.sound_speed / fluid.spacing;
            assert!((found - steps).abs() < 5e-3, "{diffusion}: {found}");
        }
    }

    /// What is left for particles that stand more unevenly than on a lattice.
    #[test]
    fn steps_are_at_most_a_little_over_half_of_the_limit() {
        for (kernel, support) in [
            ("wendland_c2", 2.0),
            ("wendland_c2", 3.0),
            ("wendland_c4", 3.0),
            ("cubic_spline", 2.0),
            ("quintic_spline", 3.0),
        ] {
            let fluid = fluid(|file| {
                file["kernel"] = kernel.into();
                file["support"] = support.into();
            });
            let own = fluid.step_limits(0.0)[0].0;
            let margin = sound_limit(&fluid) / own;
            assert!(margin > 1.9, "{kernel} {support}: {margin}");
        }
    }

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
