//! An axis: which values it shows, where its ticks are and what they are called.

use crate::render::ticks;

/// How values are spread along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Scale {
    #[default]
    Linear,
    /// Decades; values of zero and below have no place.
    Log,
}

/// Values from `low` to `high`.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    scale: Scale,
    low: f64,
    high: f64,
}

impl Axis {
    /// Covers all `values`, with a little room and round ends; those that have no place on the scale are left out.
    /// `zero` keeps zero in sight of a linear axis.
    pub fn covering(values: impl IntoIterator<Item = f64>, scale: Scale, zero: bool) -> Self {
        let shown = values.into_iter().filter(|&v| has_place(v, scale));
        let (mut low, mut high) = shown.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
            (low.min(v), high.max(v))
        });
        if low > high {
            (low, high) = (1.0, 10.0);
        }
        match scale {
            Scale::Log => {
                (low, high) = (rounded(low / 1.02, f64::floor), rounded(high * 1.02, f64::ceil));
            }
            Scale::Linear => {
                if zero {
                    (low, high) = (low.min(0.0), high.max(0.0));
                }
                let room = 0.03
                    * if high > low {
                        high - low
                    } else {
                        high.abs().max(1.0)
                    };
                low = if zero && low == 0.0 { 0.0 } else { low - room };
                high += room;
            }
        }
        Self { scale, low, high }
    }

    /// Place of a value: 0 at the low end, 1 at the high one; outside of both where it is not shown.
    pub fn place(&self, value: f64) -> f64 {
        let on = |v: f64| match self.scale {
            Scale::Linear => v,
            Scale::Log => v.log10(),
        };
        (on(value) - on(self.low)) / (on(self.high) - on(self.low))
    }

    /// Whether a value can be drawn.
    pub fn shows(&self, value: f64) -> bool {
        has_place(value, self.scale) && (-1e-9..=1.0 + 1e-9).contains(&self.place(value))
    }

    /// Values with their labels, at most about `most`.
    pub fn ticks(&self, most: usize) -> Vec<(f64, String)> {
        match self.scale {
            Scale::Linear => {
                let values = ticks::ticks(self.low, self.high, most);
                let largest = values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
                let (unit, suffix) = unit(largest);
                let scaled: Vec<f64> = values.iter().map(|v| v / unit).collect();
                let labels = ticks::labels(&scaled).into_iter();
                let labels = labels.map(|label| {
                    if label.trim_start_matches(['0', '.']).is_empty() {
                        "0".to_owned()
                    } else {
                        label + suffix
                    }
                });
                values.into_iter().zip(labels).collect()
            }
            Scale::Log => {
                let decades = self.high.log10() - self.low.log10();
                let steps: &[f64] = match decades {
                    d if d < 2.1 => &[1.0, 2.0, 5.0],
                    _ => &[1.0],
                };
                let every = (decades / most as f64).ceil().max(1.0) as i32;
                let first = self.low.log10().floor() as i32;
                let last = self.high.log10().ceil() as i32;
                (first..=last)
                    .filter(|decade| decade % every == 0)
                    .flat_map(|decade| steps.iter().map(move |step| step * 10_f64.powi(decade)))
                    .filter(|&value| self.shows(value))
                    .map(|value| (value, short(value)))
                    .collect()
            }
        }
    }
}

/// Whether a scale has a place for a value.
pub fn has_place(value: f64, scale: Scale) -> bool {
    value.is_finite() && (scale == Scale::Linear || value > 0.0)
}

/// The next of 1, 2, 5, 10, … below or above.
fn rounded(value: f64, way: fn(f64) -> f64) -> f64 {
    let decade = 10_f64.powf(value.log10().floor());
    let lead = value / decade;
    let up = way(1.5) > 1.5;
    let leads = [1.0, 2.0, 5.0, 10.0];
    let found = if up {
        leads.into_iter().find(|&step| step >= lead * 0.999_999)
    } else {
        leads.into_iter().rev().find(|&step| step <= lead * 1.000_001)
    };
    found.unwrap_or(1.0) * decade
}

/// What large values are divided by, and what stands behind them then.
fn unit(largest: f64) -> (f64, &'static str) {
    match largest {
        v if v >= 9.999e9 => (1e9, " G"),
        v if v >= 9.999e5 => (1e6, " M"),
        v if v >= 9.999e3 => (1e3, " k"),
        _ => (1.0, ""),
    }
}

/// A tick of a log axis.
fn short(value: f64) -> String {
    let (unit, suffix) = match value {
        v if v >= 0.999e9 => (1e9, " G"),
        v if v >= 0.999e6 => (1e6, " M"),
        v if v >= 0.999e3 => (1e3, " k"),
        _ => (1.0, ""),
    };
    let scaled = value / unit;
    let digits = (-scaled.log10().floor()).max(0.0) as usize;
    if digits > 4 {
        return format!("{scaled:.0e}").replace('-', "−");
    }
    format!("{scaled:.digits$}{suffix}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_log_axis_has_round_ends_and_labels() {
        let axis = Axis::covering([0.03, 0.0, 780.0, f64::NAN], Scale::Log, false);
        let labels: Vec<_> = axis.ticks(8).into_iter().map(|(_, label)| label).collect();
        assert_eq!(labels, ["0.1", "1", "10", "100", "1 k"]);
        assert!(axis.shows(0.03) && axis.shows(780.0));
        assert!(!axis.shows(0.0) && !axis.shows(-1.0) && !axis.shows(1e9));
        assert!((axis.place(1000.0) - 1.0).abs() < 1e-12, "the upper end is round");
    }

    #[test]
    fn a_short_log_axis_has_ticks_between_its_decades() {
        let axis = Axis::covering([16_386.0, 589_824.0], Scale::Log, false);
        let labels: Vec<_> = axis.ticks(8).into_iter().map(|(_, label)| label).collect();
        assert_eq!(labels, ["10 k", "20 k", "50 k", "100 k", "200 k", "500 k", "1 M"]);
    }

    #[test]
    fn a_linear_axis_keeps_zero_when_asked() {
        let axis = Axis::covering([30_000.0, 120_000.0], Scale::Linear, true);
        let labels: Vec<_> = axis.ticks(6).into_iter().map(|(_, label)| label).collect();
        assert_eq!(labels, ["0", "50 k", "100 k"]);
        assert_eq!(axis.place(0.0), 0.0);
        let near = Axis::covering([5.0, 6.0], Scale::Linear, false);
        assert!(near.place(0.0) < 0.0);
    }

    #[test]
    fn an_axis_of_nothing_or_of_one_value_can_be_drawn() {
        for scale in [Scale::Linear, Scale::Log] {
            for values in [vec![], vec![3.0], vec![0.0]] {
                let axis = Axis::covering(values, scale, true);
                assert!(axis.low < axis.high, "{axis:?}");
                assert!(!axis.ticks(6).is_empty(), "{axis:?}");
            }
        }
    }
}
