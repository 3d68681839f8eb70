//! Smoothing kernels W(r) = σ/hᵈ f(r/h), in f64; `shaders/physics/fluid/kernels/` has the same in f32.

use std::f64::consts::PI;

use crate::scene::model::Kernel;

/// σ of a kernel in one to three dimensions, so that its integral is one.
pub fn normalization(kernel: Kernel, dimensions: usize) -> f64 {
    let of = match kernel {
        // Monaghan 1992.
        Kernel::CubicSpline => [2.0 / 3.0, 10.0 / (7.0 * PI), 1.0 / PI],
        // Dehnen and Aly 2012, Table 1; in one dimension the polynomial is another, see `shape`.
        Kernel::WendlandC2 => [5.0 / 8.0, 7.0 / (4.0 * PI), 21.0 / (16.0 * PI)],
        Kernel::WendlandC4 => [3.0 / 4.0, 9.0 / (4.0 * PI), 495.0 / (256.0 * PI)],
        // Morris 1997.
        Kernel::QuinticSpline => [1.0 / 120.0, 7.0 / (478.0 * PI), 1.0 / (120.0 * PI)],
        // Poly6 (Müller 2003 in 3D).
        Kernel::Muller => [35.0 / 32.0, 4.0 / PI, 315.0 / (64.0 * PI)],
    };
    of[dimensions - 1]
}

/// f(q), zero from the kernel's reach on.
pub fn shape(kernel: Kernel, dimensions: usize, q: f64) -> f64 {
    if q >= kernel.reach() {
        return 0.0;
    }
    let u = 1.0 - 0.5 * q;
    match kernel {
        Kernel::CubicSpline if q < 1.0 => 1.0 - 1.5 * q * q + 0.75 * q * q * q,
        Kernel::CubicSpline => 0.25 * (2.0 - q).powi(3),
        Kernel::WendlandC2 if dimensions == 1 => u.powi(3) * (1.5 * q + 1.0),
        Kernel::WendlandC2 => u.powi(4) * (2.0 * q + 1.0),
        Kernel::WendlandC4 if dimensions == 1 => u.powi(5) * (2.0 * q * q + 2.5 * q + 1.0),
        Kernel::WendlandC4 => u.powi(6) * (35.0 / 12.0 * q * q + 3.0 * q + 1.0),
        Kernel::QuinticSpline => {
            let term = |end: f64| (end - q).max(0.0).powi(5);
            term(3.0) - 6.0 * term(2.0) + 15.0 * term(1.0)
        }
        Kernel::Muller => (1.0 - q * q).powi(3),
    }
}

/// ρ/ρ₀ by summation over a square or cubic lattice with so many metres between its points.
pub fn lattice_density(kernel: Kernel, dimensions: usize, h: f64, spacing: f64) -> f64 {
    let reach = (kernel.reach() * h / spacing).ceil() as i32;
    let ticks = |axis: usize| if axis < dimensions { -reach..=reach } else { 0..=0 };
    let mut sum = 0.0;
    for x in ticks(0) {
        for y in ticks(1) {
            for z in ticks(2) {
                let r = spacing * f64::from(x * x + y * y + z * z).sqrt();
                sum += shape(kernel, dimensions, r / h);
            }
        }
    }
    sum * normalization(kernel, dimensions) * (spacing / h).powi(dimensions as i32)
}

/// What sums find on a square or cubic lattice, with the volume by which its density is that at rest.
pub struct Lattice {
    /// The gradient of a field that rises by 1 per metre.
    pub gradient: f64,
    // Of a particle at a flat surface, with the volume by which that gradient is 1.
    /// ρ/ρ₀ that its missing neighbors would add.
    pub surface_density: f64,
    /// Length of V Σ ∇W over the neighbors that it has, 1/m.
    pub surface_slope: f64,
    /// 2 V Σ |dW/dr| / r over those that are missing, 1/m².
    pub surface_weight: f64,
}

/// Of a lattice with so many metres between its points.
pub fn lattice(kernel: Kernel, dimensions: usize, h: f64, spacing: f64) -> Lattice {
    let reach = (kernel.reach() * h / spacing).ceil() as i32;
    let ticks = |axis: usize| if axis < dimensions { -reach..=reach } else { 0..=0 };
    let volume = (spacing / h).powi(dimensions as i32) / lattice_density(kernel, dimensions, h, spacing);
    let mut found = Lattice {
        gradient: 0.0,
        surface_density: 0.0,
        surface_slope: 0.0,
        surface_weight: 0.0,
    };
    // Those on the other side add as much to the gradient.
    for x in 1..=reach {
        for y in ticks(1) {
            for z in ticks(2) {
                let r = spacing * f64::from(x * x + y * y + z * z).sqrt();
                let along = spacing * f64::from(x);
                let steepness = volume
                    * slope_normalization(kernel, dimensions)
                    * shape_slope(kernel, dimensions, r / h).abs()
                    / h;
                found.surface_density +=
                    volume * normalization(kernel, dimensions) * shape(kernel, dimensions, r / h);
                found.surface_slope += steepness * along / r;
                found.surface_weight += 2.0 * steepness / r;
                found.gradient += 2.0 * steepness * along * along / r;
            }
        }
    }
    found.surface_slope /= found.gradient;
    found.surface_weight /= found.gradient;
    found
}

/// Factors of the weights of viscous forces along pairs (Monaghan and Gingold 1983): of 2 V |dW/dr| / r, with the volume by which
/// gradients on a lattice are right, and of the same times (r / spacing)⁴.
///
/// On a lattice such forces are those of an isotropic fluid, which resists alike along the lattice and across it, where two
/// positive factors can do that. The fluid has its viscosity on average over lattices whose rows have slid along each other.
pub fn shear(kernel: Kernel, dimensions: usize, h: f64, spacing: f64) -> [f64; 2] {
    let count = dimensions as f64;
    let reach = (kernel.reach() * h / spacing).ceil() as i32;
    let ticks = |axis: usize, more: i32| match axis < dimensions {
        true => -reach - more..=reach + more,
        false => 0..=0,
    };
    // Of weights near to a particle and, in the second place, far from it: Σ w x⁴/r², Σ w x²y²/r², Σ w x² and Σ w r², rows of
    // the lattice having slid by so many spacings from one to the next.
    let sums = |slides: [f64; 2]| {
        let mut sums = [[0.0; 4]; 2];
        for z in ticks(2, 0) {
            for y in ticks(1, 0) {
                for x in ticks(0, 2 * reach) {
                    let [y, z] = [y, z].map(f64::from);
                    let x = f64::from(x) + slides[0] * y + slides[1] * z;
                    let square = x * x + y * y + z * z;
                    if square == 0.0 {
                        continue;
                    }
                    let r = spacing * square.sqrt();
                    let near = shape_slope(kernel, dimensions, r / h).abs() / r;
                    for (sums, weight) in sums.iter_mut().zip([near, near * square * square]) {
                        sums[0] += weight * x.powi(4) / square;
                        sums[1] += weight * x * x * y * y / square;
                        sums[2] += weight * x * x;
                        sums[3] += weight * square;
                    }
                }
            }
        }
        sums
    };
    let [near, far] = sums([0.0, 0.0]);
    // An isotropic fluid has three times as much along as across.
    let mut factors = [3.0 * far[1] - far[0], near[0] - 3.0 * near[1]];
    if factors[0] * factors[1] < 0.0 {
        factors = [1.0, 0.0];
    }
    // With x² summing up to 2, an isotropic fluid has 2 d (d + 2).
    let slides: Vec<f64> = (0..8).map(|k| f64::from(k) / 8.0).collect();
    let mut mean = 0.0;
    for &of_rows in &slides {
        for &of_layers in &slides {
            let [near, far] = sums([of_rows, of_layers]);
            mean += factors[0] * near[3] + factors[1] * far[3];
        }
    }
    mean /= (slides.len() * slides.len()) as f64;
    factors.map(|factor| factor * near[2] / 2.0 * 2.0 * count * (count + 2.0) / mean)
}

/// df/dq. Of Müller's kernels, that of the spiky one with its own factor, see [`slope_normalization`].
pub fn shape_slope(kernel: Kernel, dimensions: usize, q: f64) -> f64 {
    if q >= kernel.reach() {
        return 0.0;
    }
    let u = 1.0 - 0.5 * q;
    match kernel {
        Kernel::CubicSpline if q < 1.0 => -3.0 * q + 2.25 * q * q,
        Kernel::CubicSpline => -0.75 * (2.0 - q).powi(2),
        Kernel::WendlandC2 if dimensions == 1 => -3.0 * q * u * u,
        Kernel::WendlandC2 => -5.0 * q * u.powi(3),
        Kernel::WendlandC4 if dimensions == 1 => -3.5 * q * (1.0 + 2.0 * q) * u.powi(4),
        Kernel::WendlandC4 => -14.0 / 3.0 * q * (1.0 + 2.5 * q) * u.powi(5),
        Kernel::QuinticSpline => {
            let term = |end: f64| (end - q).max(0.0).powi(4);
            -5.0 * term(3.0) + 30.0 * term(2.0) - 75.0 * term(1.0)
        }
        Kernel::Muller => -3.0 * (1.0 - q).powi(2),
    }
}

/// A bound of |df/dq|, no more than a thousandth above the largest.
pub fn steepest(kernel: Kernel, dimensions: usize) -> f64 {
    let steps = 1000;
    let at = |step: i32| kernel.reach() * f64::from(step) / f64::from(steps);
    let slopes = (0..steps).map(|step| shape_slope(kernel, dimensions, at(step)).abs());
    1.0005 * slopes.fold(0.0, f64::max)
}

/// σ of the kernel whose gradient forces use.
pub fn slope_normalization(kernel: Kernel, dimensions: usize) -> f64 {
    match kernel {
        // Spiky (Müller 2003 in 3D).
        Kernel::Muller => [2.0, 10.0 / PI, 15.0 / PI][dimensions - 1],
        _ => normalization(kernel, dimensions),
    }
}

/// Factor of (1 − q) in the Laplacian of Müller's viscosity kernel, over h^(d+2). Müller 2003 gives it in 3D; in 2D it
/// is such that the Laplacian of a parabola is right.
pub fn muller_laplacian(dimensions: usize) -> f64 {
    match dimensions {
        2 => 40.0 / PI,
        _ => 45.0 / PI,
    }
}

/// W(r) with smoothing length `h`, m⁻ᵈ.
pub fn value(kernel: Kernel, dimensions: usize, h: f64, r: f64) -> f64 {
    normalization(kernel, dimensions) / h.powi(dimensions as i32) * shape(kernel, dimensions, r / h)
}

/// dW/dr, m⁻ᵈ⁻¹.
pub fn slope(kernel: Kernel, dimensions: usize, h: f64, r: f64) -> f64 {
    slope_normalization(kernel, dimensions) / h.powi(dimensions as i32 + 1)
        * shape_slope(kernel, dimensions, r / h)
}

#[cfg(test)]
mod tests {
    use super::*;

    const KERNELS: [Kernel; 5] = [
        Kernel::CubicSpline,
        Kernel::WendlandC2,
        Kernel::WendlandC4,
        Kernel::QuinticSpline,
        Kernel::Muller,
    ];

    /// ∫ g(r) dV over a ball of radius `reach`, by Simpson's rule.
    fn integral(dimensions: usize, reach: f64, g: impl Fn(f64) -> f64) -> f64 {
        let n = 20_000;
        let step = reach / f64::from(n);
        let shell = |r: f64| [2.0, 2.0 * PI * r, 4.0 * PI * r * r][dimensions - 1] * g(r);
        (0..=n)
            .map(|i| {
                let weight = if i == 0 || i == n {
                    1.0
                } else if i % 2 == 1 {
                    4.0
                } else {
                    2.0
                };
                weight * shell(f64::from(i) * step)
            })
            .sum::<f64>()
            * step
            / 3.0
    }

    #[test]
    fn integrals_are_one() {
        for kernel in KERNELS {
            for dimensions in 1..=3 {
                let h = 0.37;
                let sum = integral(dimensions, kernel.reach() * h, |r| {
                    value(kernel, dimensions, h, r)
                });
                assert!((sum - 1.0).abs() < 1e-8, "{kernel:?} {dimensions}D: {sum}");
            }
        }
    }

    /// Worked out by hand for eight neighbors at 1 and √2 spacings.
    #[test]
    fn sums_on_a_square_lattice() {
        for (kernel, gradient, density, slope) in [
            (Kernel::WendlandC2, 0.9409, 0.1309, 0.5),
            (Kernel::CubicSpline, 1.0122, 0.1592, 0.5),
        ] {
            let found = lattice(kernel, 2, 0.1, 0.1);
            assert!((found.gradient - gradient).abs() < 1e-3, "{}", found.gradient);
            assert!(
                (found.surface_density - density).abs() < 1e-3,
                "{}",
                found.surface_density
            );
            assert!(
                (found.surface_slope * 0.1 - slope).abs() < 1e-3,
                "{}",
                found.surface_slope * 0.1
            );
        }
    }

    /// What a smooth flow of an isotropic fluid feels: ∇²v along a shear wave, whichever way it runs through the lattice.
    #[test]
    fn shear_is_alike_along_a_lattice_and_across() {
        let kernel = Kernel::WendlandC2;
        for dimensions in [2, 3] {
            let [near, far] = shear(kernel, dimensions, 1.0, 1.0);
            assert!(near >= 0.0 && far > 0.0, "{dimensions}D: {near} {far}");
            let volume = 1.0 / lattice_density(kernel, dimensions, 1.0, 1.0);
            let volume = volume / lattice(kernel, dimensions, 1.0, 1.0).gradient;
            // Of a velocity along `way` that grows with the square of the distance along `grows`.
            let found = |way: [f64; 3], grows: [f64; 3]| {
                let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
                let ticks = |axis: usize| if axis < dimensions { -2..=2 } else { 0..=0 };
                let mut sum = 0.0;
                for x in ticks(0) {
                    for y in ticks(1) {
                        for z in ticks(2) {
                            let s = [x, y, z].map(f64::from);
                            let square = dot(s, s);
                            if square > 0.0 {
                                let r = square.sqrt();
                                let weight = -2.0 * volume * slope(kernel, dimensions, 1.0, r) / r;
                                let weight = weight * (near + far * square * square);
                                sum += weight * 0.5 * dot(grows, s).powi(2) * dot(way, s).powi(2) / square;
                            }
                        }
                    }
                }
                sum
            };
            let half = 0.5_f64.sqrt();
            let straight = found([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
            let across = found([half, half, 0.0], [half, -half, 0.0]);
            assert!(
                (straight - across).abs() < 1e-9,
                "{dimensions}D: {straight} {across}"
            );
            // A lattice whose rows have not slid resists a little more than others.
            assert!((1.0..1.12).contains(&straight), "{dimensions}D: {straight}");
        }
    }

    #[test]
    fn slopes_are_derivatives() {
        for kernel in KERNELS.into_iter().filter(|&k| k != Kernel::Muller) {
            for dimensions in 1..=3 {
                for i in 1..60 {
                    let (h, r) = (0.37, f64::from(i) * 0.02);
                    let step = 1e-6;
                    let of = |r| value(kernel, dimensions, h, r);
                    let difference = (of(r + step) - of(r - step)) / (2.0 * step);
                    let exact = slope(kernel, dimensions, h, r);
                    assert!(
                        (difference - exact).abs() < 1e-6 * of(0.0) / h,
                        "{kernel:?} {dimensions}D at {r}: {difference} {exact}"
                    );
                }
            }
        }
    }

    /// −∫ r dW/dr dV = d ∫ W dV: what makes the sum over a linear field give its gradient.
    #[test]
    fn gradients_of_linear_fields_are_exact() {
        for kernel in KERNELS {
            for dimensions in 1..=3 {
                let h = 0.37;
                let moment = integral(dimensions, kernel.reach() * h, |r| {
                    -r * slope(kernel, dimensions, h, r) / dimensions as f64
                });
                assert!((moment - 1.0).abs() < 1e-8, "{kernel:?} {dimensions}D: {moment}");
            }
        }
    }

    #[test]
    fn mullers_laplacian_is_exact_for_a_parabola() {
        for dimensions in [2, 3] {
            let h: f64 = 0.37;
            let laplacian =
                |r: f64| muller_laplacian(dimensions) / h.powi(dimensions as i32 + 2) * (1.0 - r / h);
            let sum = integral(dimensions, h, |r| r * r * laplacian(r)) / (2.0 * dimensions as f64);
            assert!((sum - 1.0).abs() < 1e-8, "{dimensions}D: {sum}");
        }
    }
}
