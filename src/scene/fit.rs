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
const TOLERANCE: f64 = 1e-3;

/// Of one body.
pub struct Grains {
    /// Local, metres.
    pub position: Vec<DVec3>,
    /// m/s.
    pub velocity: Vec<DVec3>,
}

impl Grains {
    pub fn keep(&mut self, kept: &[bool]) {
        let mut marks = kept.iter();
        self.position.retain(|_| *marks.next().unwrap_or(&true));
        let mut marks = kept.iter();
        self.velocity.retain(|_| *marks.next().unwrap_or(&true));
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
pub fn check_walls(path: &str, grains: &[DVec3], radius: f64, frame: &Frame, report: &mut Report) {
    for (axis, name) in frame.axes() {
        let lowest = grains.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
        let highest = grains.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max);
        let [low, high] = frame.sides[axis];
        let sides = [
            ("min", low, frame.min[axis] - lowest),
            ("max", high, highest - frame.max[axis]),
        ];
        for (end, wall, center_beyond) in sides {
            let (beyond, says) = match wall {
                Wall::Open => (center_beyond, "particles lie outside the domain's open side"),
                Wall::Contact | Wall::Clamp | Wall::Particles | Wall::Planes => {
                    (center_beyond + radius, "reaches through the domain's side")
                }
                Wall::Periodic => (center_beyond, "particles lie outside the domain's periodic side"),
            };
            if beyond > radius * TOLERANCE {
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
        let reach = reach(radius);
        let is_free = |center: &DVec3| !obstacle.touches(*center - offset, reach);
        let kept: Vec<bool> = grains.position.iter().map(is_free).collect();
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
    let hits: Vec<Option<usize>> = grains.position.iter().map(|p| placed.body_at(*p)).collect();
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

/// Grains placed so far, by cells as wide as the least distance.
pub struct Placed {
    least_distance: f64,
    cells: HashMap<[i64; 3], Vec<(DVec3, usize)>>,
}

impl Placed {
    pub fn new(diameter: f64) -> Self {
        Self {
            least_distance: diameter * (1.0 - TOLERANCE),
            cells: HashMap::new(),
        }
    }

    fn cell(&self, point: DVec3) -> [i64; 3] {
        (point / self.least_distance)
            .floor()
            .to_array()
            .map(|cell| cell as i64)
    }

    pub fn add(&mut self, points: &[DVec3], body: usize) {
        for point in points {
            let cell = self.cell(*point);
            self.cells.entry(cell).or_default().push((*point, body));
        }
    }

    /// The body whose grain is too near.
    fn body_at(&self, point: DVec3) -> Option<usize> {
        let [x, y, z] = self.cell(point);
        let neighbors = (0..27).map(|i| [x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1]);
        neighbors
            .filter_map(|cell| self.cells.get(&cell))
            .flatten()
            .find(|(other, _)| other.distance(point) < self.least_distance)
            .map(|(_, body)| *body)
    }
}
