//! Emitters: when they flow, and where a layer's grains stand.

use std::f64::consts::PI;

use glam::DVec3;
use rand::Rng;
use rand_chacha::ChaCha8Rng;

use super::Dimensions;
use super::shapes::{self, Ball, Region};
use super::sizes::Draw;

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
    lattice(reach, spacing, dimensions, Placed::default())
        .into_iter()
        .map(|point| on_plane(center, axis, dimensions, point))
        .collect()
}

/// The same, with the lattice turned and shifted at random, and points displaced as far as they stay `width` apart, in their
/// layer and from layers a spacing away.
pub fn loose_layer(
    center: DVec3,
    axis: DVec3,
    reach: f64,
    spacing: f64,
    width: f64,
    dimensions: Dimensions,
    rng: &mut impl Rng,
) -> Vec<DVec3> {
    let mut within = |half: f64| half * (2.0 * rng.random::<f64>() - 1.0);
    let placed = Placed {
        angle: within(PI),
        shift: [within(spacing), within(spacing)],
    };
    // Inside a ball whose diameter is the gap.
    let half = (spacing - width).max(0.0) / 2.0 / 3f64.sqrt();
    let gap = half * 3f64.sqrt();
    let points = lattice((reach - gap).max(0.0), spacing, dimensions, placed);
    let mut loosen = |point: [f64; 2]| {
        let moved = [point[0] + within(half), point[1] + within(half)];
        on_plane(center, axis, dimensions, moved) + axis * within(half)
    };
    points.into_iter().map(&mut loosen).collect()
}

/// Share of its volume that a layer of grains of several sizes fills, where it is as thick as it usually is.
const FILLED: f64 = 0.4;

/// Share of a layer of this thickness that is filled, where `usual` is what it usually has, metres: fewer grains come where they are
/// to be farther apart.
pub fn filled(spacing: f64, usual: f64, dimensions: Dimensions) -> f64 {
    FILLED * (usual / spacing).powi(dimensions.count() as i32).min(1.0)
}

/// Grains of several sizes in a disc (a strip in 2D) of this radius and thickness across `axis`, without order or overlap. They
/// lie wholly inside, so that layers follow each other without overlaps too.
pub fn packed_layer(
    [center, axis]: [DVec3; 2],
    [radius, thickness, largest]: [f64; 3],
    fraction: f64,
    draw: &Draw,
    dimensions: Dimensions,
    rng: &mut ChaCha8Rng,
) -> Vec<Ball> {
    let half = 0.5 * thickness;
    if dimensions == Dimensions::Three {
        let (from, to) = (center - half * axis, center + half * axis);
        let disc = Region::Cylinder { from, to, radius };
        return shapes::pack(&disc, dimensions, draw, largest, fraction, rng);
    }
    let corner = DVec3::new(half, radius, 0.0);
    let strip = Region::Box {
        min: -corner,
        max: corner,
    };
    let across = DVec3::new(-axis.y, axis.x, 0.0);
    let balls = shapes::pack(&strip, dimensions, draw, largest, fraction, rng);
    let place = |(at, radius): Ball| (center + at.x * axis + at.y * across, radius);
    balls.into_iter().map(place).collect()
}

/// How a lattice lies in its plane.
#[derive(Debug, Clone, Copy, Default)]
struct Placed {
    /// Radians; 3D only.
    angle: f64,
    /// Metres.
    shift: [f64; 2],
}

/// Points of a lattice that are no farther than `reach` from zero.
fn lattice(reach: f64, spacing: f64, dimensions: Dimensions, placed: Placed) -> Vec<[f64; 2]> {
    let reach = reach + 1e-9 * spacing;
    // One more where the lattice is shifted.
    let more = i32::from(placed.shift != [0.0; 2]);
    let steps = (reach / spacing).ceil().max(0.0) as i32 + more;
    let mut points = Vec::new();
    if dimensions == Dimensions::Two {
        let line = (-steps..=steps).map(|i| f64::from(i) * spacing + placed.shift[0]);
        points.extend(line.filter(|s| s.abs() <= reach).map(|s| [s, 0.0]));
        return points;
    }
    let (sin, cos) = placed.angle.sin_cos();
    let rows = (f64::from(steps) * 2.0 / 3f64.sqrt()).ceil() as i32;
    for row in -rows..=rows {
        let shift = f64::from(row.rem_euclid(2)) / 2.0;
        let y = f64::from(row) * spacing * 3f64.sqrt() / 2.0 + placed.shift[1];
        for i in -steps - 1..=steps {
            let x = (f64::from(i) + shift) * spacing + placed.shift[0];
            if x.hypot(y) <= reach {
                points.push([x * cos - y * sin, x * sin + y * cos]);
            }
        }
    }
    points
}

/// A point of the plane across `axis`; of the line across it in 2D.
fn on_plane(center: DVec3, axis: DVec3, dimensions: Dimensions, [x, y]: [f64; 2]) -> DVec3 {
    if dimensions == Dimensions::Two {
        return center + DVec3::new(-axis.y, axis.x, 0.0) * x;
    }
    let (u, v) = axis.any_orthonormal_pair();
    center + u * x + v * y
}
