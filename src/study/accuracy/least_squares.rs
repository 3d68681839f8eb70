//! Fits of low order.

use glam::DVec3;

/// Unknowns of a parabola in two and three dimensions.
const UNKNOWNS: [usize; 2] = [6, 10];
/// Pivots below this share of the first one mean that samples leave the parabola open.
const SINGULAR: f64 = 1e-9;

/// Value at the origin of the parabola that fits samples (place, weight, value) best; places are of order one. None where
/// they do not determine it.
pub fn parabola(samples: impl Iterator<Item = (DVec3, f64, DVec3)>, dimensions: usize) -> Option<DVec3> {
    let n = UNKNOWNS[dimensions - 2];
    // Normal equations; the last three columns are the right sides.
    let mut rows = vec![vec![0.0; n + 3]; n];
    for (p, weight, value) in samples {
        let terms = [
            1.0,
            p.x,
            p.y,
            p.x * p.x,
            p.x * p.y,
            p.y * p.y,
            p.z,
            p.x * p.z,
            p.y * p.z,
            p.z * p.z,
        ];
        for (row, left) in rows.iter_mut().zip(terms) {
            let right = terms[..n].iter().copied().chain(value.to_array());
            row.iter_mut()
                .zip(right)
                .for_each(|(sum, right)| *sum += weight * left * right);
        }
    }
    solve(rows).map(|first| DVec3::new(first[0], first[1], first[2]))
}

/// First unknown of each right side (Gauss, with the largest pivot of each column).
fn solve(mut rows: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let n = rows.len();
    let largest = rows[0][0].abs();
    // The first unknown is eliminated last.
    for column in (0..n).rev() {
        let rest = 0..=column;
        let pivot = rest.max_by(|&a, &b| rows[a][column].abs().total_cmp(&rows[b][column].abs()))?;
        rows.swap(pivot, column);
        let row = rows[column].clone();
        if row[column].abs() <= SINGULAR * largest {
            return None;
        }
        for other in &mut rows[..column] {
            let factor = other[column] / row[column];
            other
                .iter_mut()
                .zip(&row)
                .for_each(|(value, pivot)| *value -= factor * pivot);
        }
    }
    Some(rows[0][n..].iter().map(|value| value / rows[0][0]).collect())
}
