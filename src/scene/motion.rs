//! Paths of colliders, with what events move.

use glam::Vec3;

use super::Collider;

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
