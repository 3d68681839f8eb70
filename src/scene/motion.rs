//! Paths of colliders: smooth ones as many straight pieces, with what events move.

use std::f64::consts::TAU;

use glam::{DVec3, Vec3};

use super::Collider;
use super::model::Easing;

/// Farthest that a straight piece may be off a smooth path, as a share of a particle's radius.
const OFF: f64 = 1e-3;
/// Pieces that a path may have at most; the device is stopped at the end of each.
pub const MOST_PIECES: usize = 100_000;

/// A sine in time.
pub struct Wave {
    /// Metres.
    pub amplitude: DVec3,
    /// Seconds.
    pub period: f64,
    /// Radians.
    pub phase: f64,
}

impl Wave {
    fn at(&self, time: f64) -> DVec3 {
        self.amplitude * (TAU * time / self.period + self.phase).sin()
    }

    /// Largest acceleration, m/s².
    fn acceleration(&self) -> f64 {
        self.amplitude.length() * (TAU / self.period).powi(2)
    }
}

/// The motion through `points` (seconds and metres), as a spline or in straight lines, with a wave on top, until `end`, in
/// straight pieces.
///
/// # Errors
///
/// The number of pieces, where there would be too many.
pub fn smooth_path(
    points: &[(f64, DVec3)],
    spline: bool,
    wave: Option<&Wave>,
    radius: f64,
    end: f64,
) -> Result<Vec<(f64, Vec3)>, f64> {
    let spline = (spline && points.len() > 1).then(|| Spline::through(points));
    let single = |path: Vec<(f64, DVec3)>| path.into_iter().map(|(t, x)| (t, x.as_vec3())).collect();
    if spline.is_none() && wave.is_none() {
        return Ok(single(points.to_vec()));
    }
    // Stretches of time between points, and before and behind them as far as there is a wave.
    let mut times: Vec<f64> = points.iter().map(|(time, _)| *time).collect();
    if wave.is_some() {
        times.extend([0.0, end]);
    }
    times.sort_by(f64::total_cmp);
    times.dedup();
    let mut path = Vec::new();
    let mut total = 0.0;
    let mut last = None;
    let at = |time: f64| {
        let own = match &spline {
            Some(spline) => spline.at(time),
            None => on_lines(points, time),
        };
        own + wave.map_or(DVec3::ZERO, |wave| wave.at(time))
    };
    for pair in times.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        let curved = spline.as_ref().map_or(0.0, |spline| spline.acceleration(from));
        let shaken = wave.map_or(0.0, Wave::acceleration);
        // A straight piece of τ seconds is at most a τ²/8 off a curve with the acceleration a.
        let longest = (8.0 * OFF * radius / (curved + shaken)).sqrt();
        let count = ((to - from) / longest).ceil().max(1.0);
        total += count;
        if total > MOST_PIECES as f64 {
            continue;
        }
        // Where only the run's end bounds a stretch, a longer run has the same pieces and more.
        let is_open = to == times[times.len() - 1] && points.iter().all(|(at, _)| *at < to);
        let length = if is_open { longest } else { (to - from) / count };
        let moments = (0..count as u32).map(|k| from + length * f64::from(k));
        path.extend(moments.map(|time| (time, at(time))));
        last = Some(from + length * count);
    }
    if total > MOST_PIECES as f64 {
        return Err(total);
    }
    path.extend(last.map(|time| (time, at(time))));
    Ok(single(path))
}

/// Where a camera is on its path (seconds and metres) at a time.
pub fn eased(points: &[(f64, DVec3)], easing: Easing, time: f64) -> DVec3 {
    if easing == Easing::Spline && points.len() > 1 {
        return Spline::through(points).at(time);
    }
    let next = points.partition_point(|(at, _)| *at <= time);
    let piece = next.checked_sub(1).zip(points.get(next));
    let gentle = |(last, &(end, _)): (usize, &(f64, DVec3))| {
        let begin = points[last].0;
        let share = (time - begin) / (end - begin);
        begin + (end - begin) * share * share * (3.0 - 2.0 * share)
    };
    match easing {
        Easing::Smooth => on_lines(points, piece.map_or(time, gentle)),
        Easing::Linear | Easing::Spline => on_lines(points, time),
    }
}

/// At rest before the first and after the last point.
fn on_lines(points: &[(f64, DVec3)], time: f64) -> DVec3 {
    let next = points.partition_point(|(at, _)| *at <= time);
    match (next.checked_sub(1).map(|i| points[i]), points.get(next)) {
        (Some((t0, a)), Some((t1, b))) => a.lerp(*b, (time - t0) / (t1 - t0)),
        (Some((_, offset)), None) => offset,
        (None, Some((_, offset))) => *offset,
        (None, None) => DVec3::ZERO,
    }
}

/// A cubic spline through points that begins and ends at rest: cubic pieces with the velocities for which the acceleration
/// is continuous.
struct Spline<'a> {
    points: &'a [(f64, DVec3)],
    /// m/s.
    velocity: Vec<DVec3>,
}

impl<'a> Spline<'a> {
    fn through(points: &'a [(f64, DVec3)]) -> Self {
        let count = points.len();
        let length = |i: usize| points[i + 1].0 - points[i].0;
        let slope = |i: usize| (points[i + 1].1 - points[i].1) / length(i);
        // Continuous acceleration at point i: v[i-1]/h[i-1] + 2 (1/h[i-1] + 1/h[i]) v[i] + v[i+1]/h[i]
        // = 3 (s[i-1]/h[i-1] + s[i]/h[i]); solved from the first to the last (Thomas), and back.
        let mut velocity = vec![DVec3::ZERO; count];
        let mut factor = vec![0.0; count];
        for i in 1..count - 1 {
            let (before, behind) = (1.0 / length(i - 1), 1.0 / length(i));
            let right = 3.0 * (slope(i - 1) * before + slope(i) * behind);
            let pivot = 2.0 * (before + behind) - before * factor[i - 1];
            factor[i] = behind / pivot;
            velocity[i] = (right - before * velocity[i - 1]) / pivot;
        }
        for i in (1..count - 1).rev() {
            let next = velocity[i + 1];
            velocity[i] -= factor[i] * next;
        }
        Self { points, velocity }
    }

    /// The piece that a time lies in.
    fn piece(&self, time: f64) -> usize {
        let next = self.points.partition_point(|(at, _)| *at <= time);
        next.saturating_sub(1).min(self.points.len() - 2)
    }

    fn at(&self, time: f64) -> DVec3 {
        let i = self.piece(time);
        let ((t0, a), (t1, b)) = (self.points[i], self.points[i + 1]);
        let s = ((time - t0) / (t1 - t0)).clamp(0.0, 1.0);
        let (v, w) = (self.velocity[i] * (t1 - t0), self.velocity[i + 1] * (t1 - t0));
        // Hermite's cubic.
        a + s * (v + s * (3.0 * (b - a) - 2.0 * v - w + s * (2.0 * (a - b) + v + w)))
    }

    /// Largest acceleration in the piece of a time: at one of its ends, since it changes evenly; m/s².
    fn acceleration(&self, time: f64) -> f64 {
        if time < self.points[0].0 || time >= self.points[self.points.len() - 1].0 {
            return 0.0;
        }
        let i = self.piece(time);
        let ((t0, a), (t1, b)) = (self.points[i], self.points[i + 1]);
        let h = t1 - t0;
        let (v, w, distance) = (self.velocity[i] * h, self.velocity[i + 1] * h, b - a);
        let begin = 6.0 * distance - 4.0 * v - 2.0 * w;
        let end = -6.0 * distance + 2.0 * v + 4.0 * w;
        begin.length().max(end.length()) / (h * h)
    }
}

/// One `move` event: an offset that grows evenly.
#[derive(Clone, Copy)]
pub struct Shift {
    /// Seconds.
    pub start: f64,
    pub end: f64,
    /// Metres.
    pub by: Vec3,
}

/// Adds moves to a path: each shifts the collider on top of what its path does; moves that overlap in time add up.
pub fn add(collider: &mut Collider, moves: &[Shift]) {
    if moves.is_empty() {
        return;
    }
    let own = std::mem::take(&mut collider.path);
    let mut times: Vec<f64> = own.iter().map(|(time, _)| *time).collect();
    times.extend(moves.iter().flat_map(|shift| [shift.start, shift.end]));
    times.sort_by(f64::total_cmp);
    times.dedup();
    collider.path = times
        .into_iter()
        .map(|time| (time, offset_at(&own, moves, time)))
        .collect();
}

fn offset_at(own: &[(f64, Vec3)], moves: &[Shift], time: f64) -> Vec3 {
    let next = own.partition_point(|(at, _)| *at <= time);
    let base = match (next.checked_sub(1).map(|i| own[i]), own.get(next)) {
        (Some((t0, a)), Some((t1, b))) => a.lerp(*b, ((time - t0) / (t1 - t0)) as f32),
        (Some((_, offset)), None) => offset,
        (None, Some((_, offset))) => *offset,
        (None, None) => Vec3::ZERO,
    };
    let share = |shift: &Shift| ((time - shift.start) / (shift.end - shift.start)).clamp(0.0, 1.0);
    moves
        .iter()
        .map(|shift| shift.by * share(shift) as f32)
        .fold(base, |sum, by| sum + by)
}

#[cfg(test)]
mod tests {
    use super::*;

    const RADIUS: f64 = 0.005;

    fn at(path: &[(f64, Vec3)], time: f64) -> DVec3 {
        let path: Vec<_> = path.iter().map(|(t, x)| (*t, x.as_dvec3())).collect();
        on_lines(&path, time)
    }

    #[test]
    fn waves_are_sines_as_closely_as_promised() {
        let wave = Wave {
            amplitude: DVec3::new(0.1, 0.0, 0.05),
            period: 0.7,
            phase: 0.4,
        };
        let path = smooth_path(&[], false, Some(&wave), RADIUS, 2.0).unwrap();
        for k in 0..=1000 {
            let time = 0.002 * f64::from(k);
            let off = (at(&path, time) - wave.at(time)).length();
            assert!(off < 1.05 * OFF * RADIUS, "{off} at {time}");
        }
        assert!(path.len() > 100 && path.len() < 2000, "{}", path.len());
        // A run that is made longer goes on along the same pieces.
        let longer = smooth_path(&[], false, Some(&wave), RADIUS, 3.0).unwrap();
        assert_eq!(longer[..path.len()], path);
        let fast = Wave { period: 1e-6, ..wave };
        assert!(smooth_path(&[], false, Some(&fast), RADIUS, 2.0).unwrap_err() > 1e6);
    }

    #[test]
    fn splines_go_smoothly_through_their_points() {
        let points = [
            (0.5, DVec3::ZERO),
            (1.0, DVec3::new(0.2, 0.1, 0.0)),
            (1.8, DVec3::new(0.1, 0.3, 0.1)),
            (2.0, DVec3::new(0.0, 0.3, 0.2)),
        ];
        let spline = Spline::through(&points);
        for (time, offset) in points {
            assert!((spline.at(time) - offset).length() < 1e-12);
        }
        // One-sided differences: velocity and acceleration are continuous, and zero velocity holds at both ends.
        let step = 1e-4;
        let slope = |t: f64| (spline.at(t + step) - spline.at(t - step)) / (2.0 * step);
        for time in [1.0, 1.8] {
            let bend = |t: f64| (slope(t + step) - slope(t - step)) / (2.0 * step);
            let (left, right) = (bend(time - 3.0 * step), bend(time + 3.0 * step));
            assert!(
                (left - right).length() < 0.01 * left.length().max(1.0),
                "{left} {right}"
            );
        }
        assert!(slope(0.5 + 2.0 * step).length() < 0.01 && slope(2.0 - 2.0 * step).length() < 0.01);

        let path = smooth_path(&points, true, None, RADIUS, 9.0).unwrap();
        assert!(path[0].0 == 0.5 && (path[path.len() - 1].0 - 2.0).abs() < 1e-12);
        for k in 0..=1500 {
            let time = 0.5 + 0.001 * f64::from(k);
            let off = (at(&path, time) - spline.at(time)).length();
            assert!(off < 1.05 * OFF * RADIUS, "{off} at {time}");
        }
        let straight = smooth_path(&points, false, None, RADIUS, 9.0).unwrap();
        assert_eq!(straight.len(), points.len());
    }
}
