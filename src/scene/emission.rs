//! Emitters: when they flow, and where a layer's grains stand.

use glam::DVec3;

use super::Dimensions;

/// When an emitter flows: from and until, seconds.
pub fn flows(on_at_start: bool, switches: &[(f64, bool)], end: f64) -> Vec<(f64, f64)> {
    let mut flows = Vec::new();
    let mut since = on_at_start.then_some(0.0);
    for &(time, on) in switches.iter().filter(|(time, _)| *time < end) {
        match (since, on) {
            (None, true) => since = Some(time),
            (Some(from), false) => {
                flows.push((from, time));
                since = None;
            }
            _ => {}
        }
    }
    flows.extend(since.map(|from| (from, end)));
    flows
}

/// Points across `axis`, no farther than `reach` from the center: a hexagonal lattice, or a line in 2D.
pub fn layer(center: DVec3, axis: DVec3, reach: f64, spacing: f64, dimensions: Dimensions) -> Vec<DVec3> {
    let reach = reach + 1e-9 * spacing;
    let steps = (reach / spacing).ceil().max(0.0) as i32;
    let mut points = Vec::new();
    if dimensions == Dimensions::Two {
        let along = DVec3::new(-axis.y, axis.x, 0.0);
        let line = (-steps..=steps).map(|i| f64::from(i) * spacing);
        points.extend(line.filter(|s| s.abs() <= reach).map(|s| center + along * s));
        return points;
    }
    let (u, v) = axis.any_orthonormal_pair();
    let rows = (f64::from(steps) * 2.0 / 3f64.sqrt()).ceil() as i32;
    for row in -rows..=rows {
        let shift = f64::from(row.rem_euclid(2)) / 2.0;
        let y = f64::from(row) * spacing * 3f64.sqrt() / 2.0;
        for i in -steps - 1..=steps {
            let x = (f64::from(i) + shift) * spacing;
            if x.hypot(y) <= reach {
                points.push(center + u * x + v * y);
            }
        }
    }
    points
}
