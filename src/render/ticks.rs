//! Round numbers along a range, and how they are written.

/// At most about `most` round values (1, 2 or 5 times a power of ten apart) from `low` to `high`.
pub fn ticks(low: f64, high: f64, most: usize) -> Vec<f64> {
    let rough = (high - low) / most.max(1) as f64;
    // So near to each other, or so far apart, numbers have no round ones between them.
    if !rough.is_normal() || rough <= low.abs().max(high.abs()) * f64::EPSILON {
        return vec![low, high];
    }
    let power = 10.0_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|m| m * power)
        .find(|&step| step >= rough * 0.999)
        .unwrap_or(10.0 * power);
    let first = (low / step - 1e-6).ceil() as i64;
    let last = (high / step + 1e-6).floor() as i64;
    (first..=last).map(|k| k as f64 * step).collect()
}

/// The values with as many decimals as tell them apart; very large and very small ones with a power of ten.
pub fn labels(values: &[f64]) -> Vec<String> {
    let largest = values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let step = values
        .windows(2)
        .map(|w| w[1] - w[0])
        .fold(f64::INFINITY, f64::min);
    let step = if step.is_finite() {
        step
    } else {
        largest.max(1e-300)
    };
    if largest >= 1e6 || (largest > 0.0 && largest < 1e-3) {
        let digits = (largest.log10().floor() - step.log10().floor()).clamp(0.0, 8.0) as usize;
        return values
            .iter()
            .map(|&v| {
                if v == 0.0 {
                    "0".into()
                } else {
                    format!("{v:.digits$e}").replace('-', "−")
                }
            })
            .collect();
    }
    let decimals = (-(step * 1.0001).log10().floor()).clamp(0.0, 8.0) as usize;
    let written = |v: &f64| format!("{:.decimals$}", v + 0.0).replace('-', "−");
    values.iter().map(written).collect()
}

/// A count with its thousands set apart: 65,536.
pub fn grouped(count: u32) -> String {
    let digits = count.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(ticks(0.0, 1.0, 5), [0.0, 0.2, 0.4, 0.6000000000000001, 0.8, 1.0]);
        assert_eq!(
            labels(&ticks(0.0, 1.0, 5)),
            ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]
        );
        assert_eq!(labels(&ticks(1000.0, 2000.0, 4)), ["1000", "1500", "2000"]);
        assert_eq!(labels(&ticks(-0.3, 0.3, 4)), ["−0.2", "0.0", "0.2"]);
        assert_eq!(labels(&ticks(0.0, 4e7, 4)), ["0", "1e7", "2e7", "3e7", "4e7"]);
    }

    #[test]
    fn ranges_that_numbers_do_not_resolve_have_their_ends() {
        for [low, high] in [
            [0.0, 5e-324],
            [-f64::MAX, f64::MAX],
            [1.0, 1.0 + f64::EPSILON],
            [1e300, 1.1e300],
        ] {
            let ticks = ticks(low, high, 5);
            assert!((1..=7).contains(&ticks.len()), "{low:e} to {high:e}: {ticks:?}");
            assert_eq!(labels(&ticks).len(), ticks.len());
        }
    }

    #[test]
    fn thousands_stand_apart() {
        assert_eq!(grouped(5), "5");
        assert_eq!(grouped(65_536), "65,536");
        assert_eq!(grouped(1_000_000), "1,000,000");
    }
}
