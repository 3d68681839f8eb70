//! A value over time, and what experiments are asked about it.

/// Times, ascending, with their values; linear between them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Series {
    times: Vec<f64>,
    values: Vec<f64>,
}

/// How well a series follows measured points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fit {
    /// What is added to the points' times.
    pub shift: f64,
    /// Root of the mean square of the differences, each over its point's value.
    pub rms: f64,
}

impl Series {
    /// Sorted by time; of points at one time the last stays.
    pub fn new(points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let mut points: Vec<_> = points.into_iter().collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut series = Self::default();
        for (time, value) in points {
            if series.times.last() == Some(&time) {
                series.values.pop();
                series.times.pop();
            }
            series.times.push(time);
            series.values.push(value);
        }
        series
    }

    /// Adds a point behind all others.
    pub fn push(&mut self, time: f64, value: f64) {
        assert!(self.times.last().is_none_or(|&last| last < time), "times ascend");
        self.times.push(time);
        self.values.push(value);
    }

    pub fn points(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.times.iter().copied().zip(self.values.iter().copied())
    }

    pub fn len(&self) -> usize {
        self.times.len()
    }

    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }

    /// The same with other units: times and values are multiplied.
    pub fn scaled(&self, time: f64, value: f64) -> Self {
        Self::new(self.points().map(|(t, v)| (t * time, v * value)))
    }

    /// The points from `from` to `to`.
    pub fn within(&self, from: f64, to: f64) -> Self {
        Self::new(self.points().filter(|&(t, _)| (from..=to).contains(&t)))
    }

    /// The value at a time; none before the first and after the last.
    pub fn at(&self, time: f64) -> Option<f64> {
        let next = self.times.partition_point(|&t| t < time);
        let (&after, &value) = (self.times.get(next)?, self.values.get(next)?);
        if after == time {
            return Some(value);
        }
        let before = next.checked_sub(1)?;
        let part = (time - self.times[before]) / (after - self.times[before]);
        Some(self.values[before] + part * (value - self.values[before]))
    }

    pub fn lowest(&self) -> f64 {
        self.values.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// Time and value of the highest point.
    pub fn peak(&self) -> Option<(f64, f64)> {
        self.points().max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// When the value first reaches `threshold` from below.
    pub fn arrival(&self, threshold: f64) -> Option<f64> {
        let next = self.values.iter().position(|&value| value >= threshold)?;
        let Some(before) = next.checked_sub(1) else {
            return Some(self.times[0]);
        };
        let part = (threshold - self.values[before]) / (self.values[next] - self.values[before]);
        Some(self.times[before] + part * (self.times[next] - self.times[before]))
    }

    /// Integral over time from `from` to `to` (pressure gives the impulse on an area); none where the series does not
    /// reach that far.
    pub fn integral(&self, from: f64, to: f64) -> Option<f64> {
        let ends = [(from, self.at(from)?), (to, self.at(to)?)];
        let inside = self.points().filter(|&(t, _)| from < t && t < to);
        let all: Vec<_> = ends[..1]
            .iter()
            .copied()
            .chain(inside)
            .chain(ends[1..].iter().copied())
            .collect();
        Some(
            all.windows(2)
                .map(|p| (p[1].0 - p[0].0) * (p[0].1 + p[1].1) / 2.0)
                .sum(),
        )
    }

    /// Mean over time from `from` to `to`: the height of a plateau.
    pub fn mean(&self, from: f64, to: f64) -> Option<f64> {
        Some(self.integral(from, to)? / (to - from))
    }

    /// Each value becomes the mean over `width` of time around it, over what there is near the ends.
    pub fn moving_average(&self, width: f64) -> Self {
        let (Some(&first), Some(&last)) = (self.times.first(), self.times.last()) else {
            return Self::default();
        };
        let smooth = |(time, value): (f64, f64)| {
            let (from, to) = ((time - width / 2.0).max(first), (time + width / 2.0).min(last));
            let mean = if to > from { self.mean(from, to) } else { None };
            (time, mean.unwrap_or(value))
        };
        Self::new(self.points().map(smooth))
    }

    /// Share of the time from `from` to `to` that the series spends between two others, sampled at 1000 times; none
    /// where one of the three does not reach that far.
    pub fn share_within(&self, low: &Self, high: &Self, from: f64, to: f64) -> Option<f64> {
        const SAMPLES: u32 = 1000;
        let mut inside = 0;
        for sample in 0..SAMPLES {
            let time = from + (to - from) * (f64::from(sample) + 0.5) / f64::from(SAMPLES);
            let value = self.at(time)?;
            inside += u32::from(low.at(time)? <= value && value <= high.at(time)?);
        }
        Some(f64::from(inside) / f64::from(SAMPLES))
    }

    /// Root of the mean square of the difference to `other`, at the times of `other` from `from` to `to`; none where
    /// this series does not reach that far.
    pub fn rms_difference(&self, other: &Self, from: f64, to: f64) -> Option<f64> {
        let within = other.within(from, to);
        mean_square(within.points().map(|(time, value)| Some(self.at(time)? - value)))
    }

    /// How well this series follows `measured` points whose times are moved by `shift`; none unless it reaches all.
    pub fn fit(&self, measured: &Self, shift: f64) -> Option<Fit> {
        let rms = mean_square(
            measured
                .points()
                .map(|(time, value)| Some(self.at(time + shift)? / value - 1.0)),
        )?;
        Some(Fit { shift, rms })
    }

    /// The best of all fits whose shift is at most `limit` either way.
    pub fn best_fit(&self, measured: &Self, limit: f64) -> Option<Fit> {
        const STEPS: i32 = 200;
        let best = |middle: f64, reach: f64| {
            (-STEPS..=STEPS)
                .map(|step| middle + reach * f64::from(step) / f64::from(STEPS))
                .filter(|shift| shift.abs() <= limit)
                .filter_map(|shift| self.fit(measured, shift))
                .min_by(|a, b| a.rms.total_cmp(&b.rms))
        };
        let coarse = best(0.0, limit)?;
        best(coarse.shift, limit / f64::from(STEPS))
    }
}

/// Root of the mean of squares; none when one is missing or there is nothing.
fn mean_square(differences: impl Iterator<Item = Option<f64>>) -> Option<f64> {
    let squares: Vec<f64> = differences.map(|d| d.map(|d| d * d)).collect::<Option<_>>()?;
    (!squares.is_empty()).then(|| (squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line() -> Series {
        Series::new([(2.0, 5.0), (0.0, 1.0), (1.0, 3.0), (4.0, 9.0)])
    }

    #[test]
    fn values_lie_between_points() {
        assert_eq!(line().at(3.0), Some(7.0));
        assert_eq!((line().at(0.0), line().at(4.0)), (Some(1.0), Some(9.0)));
        assert_eq!((line().at(-0.1), line().at(4.1)), (None, None));
        assert_eq!(line().scaled(2.0, 10.0).at(6.0), Some(70.0));
    }

    #[test]
    fn integrals_count_parts_of_intervals() {
        assert_eq!(line().integral(0.5, 3.0), Some(11.25));
        assert_eq!(line().mean(0.5, 3.0), Some(4.5));
        assert_eq!(line().integral(0.5, 5.0), None);
    }

    #[test]
    fn arrivals_and_peaks() {
        assert_eq!(line().arrival(6.0), Some(2.5));
        assert_eq!(line().arrival(10.0), None);
        let bump = Series::new([(0.0, 0.0), (1.0, 4.0), (2.0, 1.0)]);
        assert_eq!(bump.peak(), Some((1.0, 4.0)));
        assert_eq!(bump.lowest(), 0.0);
    }

    #[test]
    fn a_moving_average_takes_a_spike_down_and_keeps_its_impulse() {
        let spike = Series::new((0..=1000).map(|i| {
            let t = f64::from(i) / 1000.0;
            (t, if i == 500 { 100.0 } else { 1.0 })
        }));
        let smooth = spike.moving_average(0.01);
        let peak = smooth.peak().unwrap().1;
        assert!((peak - (1.0 + 99.0 * 0.001 / 0.01)).abs() < 1e-6, "{peak}");
        let [a, b] = [&spike, &smooth].map(|s| s.integral(0.0, 1.0).unwrap());
        assert!((a - b).abs() < 1e-3, "{a} {b}");
    }

    #[test]
    fn a_late_series_is_found_out() {
        // Z = 1 + T², seen 0.12 too late.
        let ours = Series::new((0..400).map(|i| {
            let t = f64::from(i) / 100.0;
            (t, 1.0 + (t - 0.12).powi(2))
        }));
        let measured = Series::new((3..30).map(|i| {
            let t = f64::from(i) / 10.0;
            (t, 1.0 + t * t)
        }));
        let plain = ours.fit(&measured, 0.0).unwrap();
        let best = ours.best_fit(&measured, 0.2).unwrap();
        assert!((best.shift - 0.12).abs() < 2e-3 && best.rms < 1e-3, "{best:?}");
        assert!(plain.rms > 0.05, "{plain:?}");
        let held = ours.best_fit(&measured, 0.05).unwrap();
        assert!((held.shift - 0.05).abs() < 1e-9 && held.rms > 0.02, "{held:?}");
        // A series that ends too early is no fit.
        assert!(
            Series::new([(0.0, 1.0), (1.0, 2.0)])
                .best_fit(&measured, 0.2)
                .is_none()
        );
    }

    #[test]
    fn time_in_a_band_is_a_share() {
        let low = Series::new([(0.0, 0.0), (10.0, 0.0)]);
        let high = Series::new([(0.0, 1.0), (10.0, 1.0)]);
        let ramp = Series::new([(0.0, 0.0), (10.0, 4.0)]);
        assert_eq!(ramp.share_within(&low, &high, 0.0, 10.0), Some(0.25));
        assert_eq!(ramp.share_within(&low, &high, 0.0, 11.0), None);
        let off = ramp.rms_difference(&low, 0.0, 10.0).unwrap();
        assert!((off - 8.0_f64.sqrt()).abs() < 1e-12, "{off}");
    }
}
