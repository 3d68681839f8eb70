//! What one way to compute a case came to, and which ways nobody beats in time and in error.

use serde::Serialize;

use super::subjects::Way;
use crate::gpu::timing::median;
use crate::study::accuracy::record::Record;

/// A way's runs, which differ in time alone.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Rung {
    pub case: String,
    pub name: String,
    pub set: Vec<String>,
    /// Factor on the length of a step.
    pub step: f64,
    pub resolution: u32,
    pub particles: u32,
    pub steps: u64,
    /// s.
    pub simulated: f64,
    /// Of each run, s.
    pub wall: Vec<f64>,
    pub particle_updates: u64,
    /// In reach of a particle at the start, boundary particles included.
    pub pairs_per_particle: f64,
    /// Magnitude of the case's figure, percent; none where there was nothing to measure.
    pub error: Option<f64>,
    /// Why there is no result.
    pub trouble: Option<String>,
}

impl Rung {
    /// Of the first run.
    pub fn new(record: &Record, way: &Way, figure: &str, pairs_per_particle: f64) -> Self {
        let value = record.figure(figure).and_then(|figure| figure.value);
        let missing = value.is_none().then(|| format!("no {figure}"));
        Self {
            case: record.case.clone(),
            name: way.name.clone(),
            set: way.set.clone(),
            step: way.step,
            resolution: record.resolution,
            particles: record.particles,
            steps: record.steps,
            simulated: record.simulated,
            wall: vec![record.wall],
            particle_updates: record.particle_updates,
            pairs_per_particle,
            error: value.map(f64::abs),
            trouble: record
                .diverged
                .as_ref()
                .map(|why| format!("diverged: {why}"))
                .or(missing),
        }
    }

    /// A way without a result.
    pub fn failed(case: &str, way: &Way, why: String) -> Self {
        Self {
            case: case.to_owned(),
            name: way.name.clone(),
            set: way.set.clone(),
            step: way.step,
            resolution: way.resolution,
            particles: 0,
            steps: 0,
            simulated: 0.0,
            wall: Vec::new(),
            particle_updates: 0,
            pairs_per_particle: 0.0,
            error: None,
            trouble: Some(why),
        }
    }

    /// Median over the runs, s/s.
    pub fn wall_per_simulated(&self) -> Option<f64> {
        let wall = median(self.wall.clone());
        (wall / self.simulated)
            .is_finite()
            .then_some(wall / self.simulated)
    }

    /// Shortest and longest run, s/s.
    pub fn spread(&self) -> Option<[f64; 2]> {
        self.wall_per_simulated()?;
        let of = |pick: fn(f64, f64) -> f64| self.wall.iter().copied().reduce(pick);
        Some([of(f64::min)? / self.simulated, of(f64::max)? / self.simulated])
    }

    pub fn particle_steps_per_s(&self) -> Option<f64> {
        let rate = self.particle_updates as f64 / median(self.wall.clone());
        rate.is_finite().then_some(rate)
    }

    /// From both sides.
    pub fn pairs_per_s(&self) -> Option<f64> {
        Some(self.particle_steps_per_s()? * self.pairs_per_particle)
    }

    /// Time and error, where there are both.
    pub fn point(&self) -> Option<[f64; 2]> {
        match self.trouble {
            Some(_) => None,
            None => Some([self.wall_per_simulated()?, self.error?]),
        }
    }
}

/// Which points no other is as good as in both and better in one, in the order of the first coordinate.
pub fn front(points: &[[f64; 2]]) -> Vec<usize> {
    let beats = |a: &[f64; 2], b: &[f64; 2]| a[0] <= b[0] && a[1] <= b[1] && a != b;
    let mut front: Vec<usize> = (0..points.len())
        .filter(|&index| !points.iter().any(|other| beats(other, &points[index])))
        .collect();
    front.sort_by(|&a, &b| points[a][0].total_cmp(&points[b][0]));
    front
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::accuracy::record::tests::record;

    #[test]
    fn nobody_beats_the_front() {
        let points = [
            [4.0, 1.0],
            [1.0, 4.0],
            [2.0, 2.0],
            [3.0, 3.0],
            [2.0, 5.0],
            [4.0, 1.0],
        ];
        assert_eq!(front(&points), [1, 2, 0, 5]);
        assert!(front(&[]).is_empty());
    }

    #[test]
    fn a_rung_tells_rates_and_spread() {
        let way = Way {
            name: "wcsph".into(),
            set: Vec::new(),
            step: 1.0,
            resolution: 50,
        };
        let rung = |error: f64| Rung::new(&record("wcsph", 50, error), &way, "L1 of speed", 28.0);
        let mut some = rung(-1.5);
        let first = some.wall[0];
        some.wall.extend([2.0 * first, 3.0 * first]);
        assert_eq!(some.error, Some(1.5));
        assert!((some.wall_per_simulated().unwrap() - first).abs() < 1e-12);
        assert_eq!(some.spread(), Some([first / 2.0, 1.5 * first]));
        let rate = some.particle_steps_per_s().unwrap();
        assert!((some.pairs_per_s().unwrap() / rate - 28.0).abs() < 1e-9);
        assert!(some.point().is_some());
        let none = rung(f64::NAN);
        assert!(none.point().is_none() && none.trouble.is_some());
        assert!(
            Rung::failed("a", &way, "no".into())
                .wall_per_simulated()
                .is_none()
        );
    }
}
