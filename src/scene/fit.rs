//! Whether grains fit where they are put: overlaps with walls, colliders and earlier grains.

use std::collections::HashMap;

use glam::DVec3;

use super::frame::{Frame, Report};
use super::model::Wall;
use super::obstacles::Obstacle;
use super::shapes;
use super::text::number;
use super::{Collider, Dimensions};

/// Share of a radius by which a grain may reach into a wall, a collider or another grain before it counts: rounding
/// and lattices laid side by side stay far below.
pub const TOLERANCE: f64 = 1e-3;
/// The same into walls and colliders for particles of a file, which may come from a run in which they pressed against these:
/// deeper overlaps of grains cause a warning.
pub const PRESSED: f64 = 0.2;

/// Of one body.
pub struct Grains {
    /// Local, metres.
    pub position: Vec<DVec3>,
    /// m/s.
    pub velocity: Vec<DVec3>,
    /// Where they are of several sizes, metres; otherwise empty.
    pub radius: Vec<f64>,
    /// [`TOLERANCE`] or [`PRESSED`].
    pub tolerance: f64,
}

impl Grains {
    /// Each center with its radius, which is `usual` where all have one.
    fn balls(&self, usual: f64) -> impl Iterator<Item = (DVec3, f64)> {
        let radius = move |i: usize| self.radius.get(i).copied().unwrap_or(usual);
        self.position
            .iter()
            .enumerate()
            .map(move |(i, &center)| (center, radius(i)))
    }

    pub fn keep(&mut self, kept: &[bool]) {
        let mut marks = kept.iter();
        self.position.retain(|_| *marks.next().unwrap_or(&true));
        let mut marks = kept.iter();
        self.velocity.retain(|_| *marks.next().unwrap_or(&true));
        let mut marks = kept.iter();
        self.radius.retain(|_| *marks.next().unwrap_or(&true));
    }
}

/// Removes grains whose center an earlier grain of the same file covers: they would fly apart.
pub fn remove_coincident(path: &str, grains: &mut Grains, radius: f64, report: &mut Report) {
    let mut kept = vec![false; grains.position.len()];
    for i in shapes::without_overlaps(&grains.position, radius) {
        kept[i] = true;
    }
    let removed = kept.iter().filter(|kept| !**kept).count();
    if removed > 0 {
        let all = kept.len();
        let what = "have their centers inside an earlier one and were left out";
        report
            .notes
            .push(format!("{path}: {removed} of {all} particles {what}"));
    }
    grains.keep(&kept);
}

/// Grains that reach out of the domain: through a closed side at all, through an open one with their centers.
pub fn check_walls(path: &str, grains: &Grains, radius: f64, frame: &Frame, report: &mut Report) {
    for (axis, name) in frame.axes() {
        let [low, high] = frame.sides[axis];
        for (end, wall) in [("min", low), ("max", high)] {
            let closed = matches!(wall, Wall::Contact | Wall::Clamp | Wall::Particles | Wall::Planes);
            let beyond = grains.balls(radius).map(|(center, radius)| {
                let center_beyond = match end {
                    "min" => frame.min[axis] - center[axis],
                    _ => center[axis] - frame.max[axis],
                };
                if closed {
                    center_beyond + radius
                } else {
                    center_beyond
                }
            });
            let beyond = beyond.fold(f64::NEG_INFINITY, f64::max);
            let says = match wall {
                Wall::Open => "particles lie outside the domain's open side",
                Wall::Periodic => "particles lie outside the domain's periodic side",
                _ => "reaches through the domain's side",
            };
            if beyond > radius * grains.tolerance {
                report.problem(
                    path,
                    format!("{says} {name}_{end}, by {} m", number(beyond)),
                    "move or shrink it, or make the domain larger",
                );
            }
        }
    }
}

/// Removes grains that a collider, where it stands at the start, touches.
pub fn remove_inside_colliders(
    path: &str,
    grains: &mut Grains,
    colliders: &[Collider],
    radius: f64,
    dimensions: Dimensions,
    report: &mut Report,
) {
    for (i, collider) in colliders.iter().enumerate() {
        let offset = collider
            .path
            .first()
            .map_or(DVec3::ZERO, |(_, offset)| offset.as_dvec3());
        let obstacle = Obstacle::new(&collider.shape, dimensions);
        let share = 1.0 - grains.tolerance;
        let is_free = |(center, radius)| !obstacle.touches(center - offset, share * radius);
        let kept: Vec<bool> = grains.balls(radius).map(is_free).collect();
        keep_free(path, grains, &kept, &format!("colliders[{i}]"), report);
    }
}

/// How near the center of a grain may come to a surface, metres.
pub fn reach(radius: f64) -> f64 {
    radius * (1.0 - TOLERANCE)
}

/// Removes grains that are not `kept`, since they overlap `other`.
fn keep_free(path: &str, grains: &mut Grains, kept: &[bool], other: &str, report: &mut Report) {
    let (all, removed) = (kept.len(), kept.iter().filter(|kept| !**kept).count());
    grains.keep(kept);
    lost(path, removed, all, other, report);
}

/// Removes grains that overlap a grain of an earlier body.
pub fn remove_overlaps(path: &str, grains: &mut Grains, placed: &Placed, report: &mut Report) {
    let hits = grains
        .balls(placed.largest)
        .map(|(center, radius)| placed.body_at(center, radius));
    let hits: Vec<Option<usize>> = hits.collect();
    let mut bodies: Vec<usize> = hits.iter().flatten().copied().collect();
    bodies.sort_unstable();
    let all = grains.position.len();
    for same in bodies.chunk_by(|a, b| a == b) {
        lost(path, same.len(), all, &format!("bodies[{}]", same[0]), report);
    }
    let kept: Vec<bool> = hits.iter().map(Option::is_none).collect();
    grains.keep(&kept);
}

/// A few overlapping grains are a note; more than half of a body is a mistake.
fn lost(path: &str, removed: usize, all: usize, other: &str, report: &mut Report) {
    if 2 * removed > all {
        report.problem(
            path,
            format!("overlaps {other}: {removed} of its {all} particles"),
            "move one of them, or remove one",
        );
    } else if removed > 0 {
        report.notes.push(format!(
            "{path}: {removed} of {all} particles overlap {other} and were left out"
        ));
    }
}

/// Grains placed so far, by cells as wide as the largest of them.
pub struct Placed {
    /// Radius of the largest, metres.
    largest: f64,
    /// Center, radius and body.
    cells: HashMap<[i64; 3], Vec<(DVec3, f64, usize)>>,
}

impl Placed {
    /// For grains of at most this radius, metres.
    pub fn new(largest: f64) -> Self {
        Self {
            largest,
            cells: HashMap::new(),
        }
    }

    fn cell(&self, point: DVec3) -> [i64; 3] {
        (point / least_distance(self.largest, self.largest))
            .floor()
            .to_array()
            .map(|cell| cell as i64)
    }

    pub fn add(&mut self, grains: &Grains, body: usize) {
        for (center, radius) in grains.balls(self.largest) {
            let cell = self.cell(center);
            self.cells.entry(cell).or_default().push((center, radius, body));
        }
    }

    /// The body whose grain is too near.
    fn body_at(&self, center: DVec3, radius: f64) -> Option<usize> {
        let [x, y, z] = self.cell(center);
        let neighbors = (0..27).map(|i| [x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1]);
        neighbors
            .filter_map(|cell| self.cells.get(&cell))
            .flatten()
            .find(|(other, own, _)| other.distance(center) < least_distance(radius, *own))
            .map(|(_, _, body)| *body)
    }
}

/// How near two grains of these radii may come, metres.
fn least_distance(one: f64, other: f64) -> f64 {
    (one + other) * (1.0 - TOLERANCE)
}
