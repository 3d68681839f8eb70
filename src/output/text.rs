//! Numbers for people.

use std::path::Path;

/// `1,234,567`
pub fn count(value: u64) -> String {
    let digits = value.to_string();
    let mut text = String::with_capacity(digits.len() * 4 / 3);
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// `512 B`, `1.5 KiB`, `128 MiB`
pub fn bytes(value: u64) -> String {
    const UNITS: [&str; 5] = ["KiB", "MiB", "GiB", "TiB", "PiB"];
    if value < 1024 {
        return format!("{value} B");
    }
    let mut scaled = value as f64 / 1024.0;
    let mut unit = 0;
    while scaled >= 1023.95 && unit + 1 < UNITS.len() {
        scaled /= 1024.0;
        unit += 1;
    }
    let text = format!("{scaled:.1}");
    format!("{} {}", text.strip_suffix(".0").unwrap_or(&text), UNITS[unit])
}

/// A path as a shell takes it.
pub fn quoted(path: &Path) -> String {
    let text = path.display().to_string();
    if text.chars().any(|c| !c.is_alphanumeric() && !"/._-".contains(c)) {
        format!("'{}'", text.replace('\'', "'\\''"))
    } else {
        text
    }
}

/// A duration in seconds: `3.2 s`, `2 min 05 s`, `1 h 02 min`
pub fn seconds(value: f64) -> String {
    if value < 59.95 {
        return format!("{value:.1} s");
    }
    let whole = value.round() as u64;
    match (whole / 3600, whole / 60 % 60, whole % 60) {
        (0, minutes, seconds) => format!("{minutes} min {seconds:02} s"),
        (hours, minutes, _) => format!("{hours} h {minutes:02} min"),
    }
}

/// A length with two digits: `0.25 m`, `15 mm`, `3.2 µm`
pub fn metres(value: f64) -> String {
    let (scaled, unit) = match value {
        v if v >= 0.1 => (v, "m"),
        v if v >= 1e-3 => (v * 1e3, "mm"),
        v => (v * 1e6, "µm"),
    };
    let decimals = (1 - scaled.abs().max(0.1).log10().floor() as i32).max(0) as usize;
    format!("{scaled:.decimals$} {unit}")
}

/// A large number with three digits: `842`, `12.3 k`, `4.56 M`, `1.20 G`
pub fn short(value: f64) -> String {
    let (scaled, unit) = match value {
        v if v >= 1e9 => (v / 1e9, " G"),
        v if v >= 1e6 => (v / 1e6, " M"),
        v if v >= 1e3 => (v / 1e3, " k"),
        v => return format!("{v:.0}"),
    };
    let decimals = if scaled < 10.0 {
        2
    } else if scaled < 100.0 {
        1
    } else {
        0
    };
    format!("{scaled:.decimals$}{unit}")
}

/// Text as a terminal may have it: control characters, which could move the cursor or change colors, are written as
/// `\\u{1b}`. Ends of lines and tabs stay.
pub fn printable(text: &str) -> std::borrow::Cow<'_, str> {
    let is_control = |c: char| c.is_control() && !matches!(c, '\n' | '\t');
    if !text.contains(is_control) {
        return text.into();
    }
    let mut printed = String::with_capacity(text.len());
    for c in text.chars() {
        match is_control(c) {
            true => printed.extend(c.escape_unicode()),
            false => printed.push(c),
        }
    }
    printed.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_have_separators() {
        let texts = [0, 12, 999, 1000, 65_536, 1_234_567].map(count);
        assert_eq!(texts, ["0", "12", "999", "1,000", "65,536", "1,234,567"]);
    }

    #[test]
    fn bytes_are_binary_units() {
        let texts = [0, 1023, 1024, 1536, 128 << 20, (1 << 20) - 1, 3 << 30].map(bytes);
        assert_eq!(
            texts,
            ["0 B", "1023 B", "1 KiB", "1.5 KiB", "128 MiB", "1 MiB", "3 GiB"]
        );
    }

    #[test]
    fn seconds_grow_into_minutes_and_hours() {
        let texts = [0.25, 59.9, 59.97, 125.0, 3725.0].map(seconds);
        assert_eq!(
            texts,
            ["0.2 s", "59.9 s", "1 min 00 s", "2 min 05 s", "1 h 02 min"]
        );
    }

    #[test]
    fn metres_keep_two_digits() {
        let texts = [0.25, 0.1192, 0.0153, 3.2e-6, 12.0].map(metres);
        assert_eq!(texts, ["0.25 m", "0.12 m", "15 mm", "3.2 µm", "12 m"]);
    }

    #[test]
    fn short_keeps_three_digits() {
        let texts = [12.0, 12_300.0, 4_560_000.0, 1.2e9, 450e9].map(short);
        assert_eq!(texts, ["12", "12.3 k", "4.56 M", "1.20 G", "450 G"]);
    }
}
