//! How far values are from the truth, and how that falls with resolution.

/// Of the differences between values found and true ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Norms {
    /// Mean of the magnitudes.
    pub l1: f64,
    /// Root of the mean of the squares (RMS).
    pub l2: f64,
    /// Largest magnitude.
    pub largest: f64,
}

impl Norms {
    /// Of pairs (found, true), each of which counts the same. NaN of none, and where a value is NaN.
    pub fn new(pairs: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let mut count = 0.0;
        let (mut sum, mut squares, mut largest) = (0.0, 0.0, 0.0_f64);
        for (found, expected) in pairs {
            let off = (found - expected).abs();
            count += 1.0;
            sum += off;
            squares += off * off;
            largest = if off > largest || off.is_nan() {
                off
            } else {
                largest
            };
        }
        Self {
            l1: sum / count,
            l2: (squares / count).sqrt(),
            largest: if count > 0.0 { largest } else { f64::NAN },
        }
    }

    /// As shares of a scale (floor pressure, lid speed, largest speed).
    pub fn over(self, scale: f64) -> Self {
        Self {
            l1: self.l1 / scale,
            l2: self.l2 / scale,
            largest: self.largest / scale,
        }
    }
}

/// Mean of |found − true| over the mean of |true|: the L1 error of PySPH's Taylor–Green, with speeds as values.
pub fn relative_l1(pairs: impl IntoIterator<Item = (f64, f64)>) -> f64 {
    let (mut off, mut scale) = (0.0, 0.0);
    for (found, expected) in pairs {
        off += (found - expected).abs();
        scale += expected.abs();
    }
    off / scale
}

/// Order p of error ∝ resolution⁻ᵖ (particles across, steps per contact), by least squares of logarithms over all
/// points; none for fewer than two errors above zero.
pub fn order(points: &[(f64, f64)]) -> Option<f64> {
    let logs: Vec<(f64, f64)> = points
        .iter()
        .filter(|(n, error)| *n > 0.0 && *error > 0.0 && error.is_finite())
        .map(|(n, error)| (n.ln(), error.ln()))
        .collect();
    let count = logs.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| logs.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let spread: f64 = logs.iter().map(|p| (p.0 - x).powi(2)).sum();
    let both: f64 = logs.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    (spread > 0.0).then(|| -both / spread)
}

/// Order between each resolution and the next.
pub fn orders(points: &[(f64, f64)]) -> Vec<Option<f64>> {
    points.windows(2).map(order).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn norms_of_known_differences() {
        let norms = Norms::new([(1.0, 0.0), (2.0, 5.0), (4.0, 4.0), (0.0, 0.0)]);
        assert_eq!((norms.l1, norms.largest), (1.0, 3.0));
        assert!((norms.l2 - 2.5_f64.sqrt()).abs() < 1e-15);
        assert_eq!(norms.over(10.0).largest, 0.3);
        assert!(Norms::new([(f64::NAN, 1.0), (1.0, 1.0)]).largest.is_nan());
        assert!(Norms::new([]).largest.is_nan());
        assert!((relative_l1([(1.1, 1.0), (2.7, 3.0)]) - 0.1).abs() < 1e-12);
    }

    #[test]
    fn orders_of_convergence() {
        // PySPH's EDAC on Taylor–Green: 2.75, 1.93 and 1.38 % at 25, 50 and 100 across is half an order.
        let edac = [(25.0, 2.75), (50.0, 1.93), (100.0, 1.38)];
        assert!((order(&edac).unwrap() - 0.497).abs() < 1e-3, "{:?}", order(&edac));
        let second = [(20.0, 4e-3), (40.0, 1e-3), (80.0, 2.5e-4)];
        assert!((order(&second).unwrap() - 2.0).abs() < 1e-12);
        let pairs = orders(&[(20.0, 4e-3), (40.0, 1e-3), (80.0, 1e-3), (160.0, f64::NAN)]);
        assert!((pairs[0].unwrap() - 2.0).abs() < 1e-12 && pairs[1].unwrap().abs() < 1e-12);
        assert_eq!(pairs[2], None);
        assert_eq!(order(&[(10.0, 1.0)]), None);
    }
}
