//! Bodies: filled with grains, then freed of what overlaps earlier bodies, colliders or walls.

use std::collections::HashMap;
use std::path::Path;

use glam::{DVec3, IVec3};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use super::frame::{Frame, Report};
use super::mesh::Mesh;
use super::model::{self, Arrangement, Body, SceneFile, Shape, Wall};
use super::obstacles::{self, FILE_MEND, check_corners, turn_and_place};
use super::shapes::{self, Region};
use super::text::number;
use super::{Collider, Dimensions, Particles, particle_file};

/// Ids, offsets and dispatches stay far inside 32 bits.
pub const MOST_PARTICLES: u64 = 1 << 27;

/// Share of a radius by which a grain may reach into a wall, a collider or another grain before it counts: rounding
/// and lattices laid side by side stay far below.
const TOLERANCE: f64 = 1e-3;

/// The grains that are there from the start, in the order of the bodies.
pub fn fill(
    file: &SceneFile,
    frame: &Frame,
    colliders: &[Collider],
    folder: &Path,
    report: &mut Report,
) -> Particles {
    let radius = file.grains.radius;
    let mut placed = Placed::new(2.0 * radius * (1.0 - TOLERANCE));
    let mut particles = Particles::default();
    for (i, body) in file.bodies.iter().enumerate() {
        let path = format!("bodies[{i}]");
        let Some(mut grains) = grains(i, body, file, frame, folder, report) else {
            continue;
        };
        if grains.position.is_empty() {
            let mend = format!("make its shape larger or grains.radius ({} m) smaller", number(radius));
            report.problem(&path, "is empty: not one grain fits", mend);
            continue;
        }
        check_walls(&path, &grains.position, radius, frame, report);
        remove_inside_colliders(&path, &mut grains, colliders, radius, frame.dimensions, report);
        remove_overlaps(&path, &mut grains, &placed, report);
        placed.add(&grains.position, i);
        particles.position.extend(grains.position.iter().map(|p| p.as_vec3()));
        particles.velocity.extend(grains.velocity.iter().map(|v| v.as_vec3()));
    }
    particles
}

struct Grains {
    /// Local, metres.
    position: Vec<DVec3>,
    /// m/s.
    velocity: Vec<DVec3>,
}

impl Grains {
    fn keep(&mut self, kept: &[bool]) {
        let mut marks = kept.iter();
        self.position.retain(|_| *marks.next().unwrap_or(&true));
        let mut marks = kept.iter();
        self.velocity.retain(|_| *marks.next().unwrap_or(&true));
    }
}

fn grains(
    index: usize,
    body: &Body,
    file: &SceneFile,
    frame: &Frame,
    folder: &Path,
    report: &mut Report,
) -> Option<Grains> {
    let path = format!("bodies[{index}]");
    let velocity = report.optional(&format!("{path}.velocity"), body.velocity.as_ref(), frame.dimensions);
    let shape = format!("{path}.shape");
    let region = match &body.shape {
        Shape::Particles { file, placement } => {
            return from_file(&shape, file, placement, velocity, body, frame, folder, report);
        }
        filled => region(&shape, filled, frame, folder, report)?,
    };
    let radius = file.grains.radius;
    let spacing = body.spacing.unwrap_or(2.0 * radius);
    if spacing < 2.0 * radius * (1.0 - 1e-9) {
        report.problem(
            format!("{path}.spacing"),
            format!("{} m is less than a grain's diameter: grains would overlap", number(spacing)),
            format!("give at least {} m, or leave it out", number(2.0 * radius)),
        );
        return None;
    }
    let at_most = lattice_points(&region, frame.dimensions, spacing);
    if at_most > MOST_PARTICLES as f64 {
        report.problem(
            &path,
            format!("would hold about {} grains", number(at_most)),
            format!("make it smaller or grains larger: at most {MOST_PARTICLES} particles"),
        );
        return None;
    }
    // Each body has its own stream, so that changing one body leaves the others as they were.
    let mut random = ChaCha8Rng::seed_from_u64(file.seed);
    random.set_stream(index as u64);
    let position = match body.arrangement {
        Arrangement::Lattice => {
            shapes::lattice(&region, frame.dimensions, radius, spacing, body.jitter, &mut random)
        }
        Arrangement::Random => shapes::random(&region, frame.dimensions, radius, body.fraction, &mut random),
    };
    let velocity = vec![velocity; position.len()];
    Some(Grains { position, velocity })
}

/// Local coordinates.
fn region(path: &str, shape: &Shape, frame: &Frame, folder: &Path, report: &mut Report) -> Option<Region> {
    let mut point = |key: &str, given: &model::Coordinates| {
        let point = report.vector(&format!("{path}.{key}"), given, frame.dimensions);
        frame.local(point)
    };
    match shape {
        Shape::Box { min, max } => {
            let (min, max) = (point("min", min), point("max", max));
            check_corners(path, min, max, frame, report).then_some(Region::Box { min, max })
        }
        Shape::Sphere { center, radius } => Some(Region::Sphere {
            center: point("center", center),
            radius: *radius,
        }),
        Shape::Cylinder { from, to, radius } => {
            if frame.dimensions == Dimensions::Two {
                report.problem(path, "a cylinder in a 2D scene", "use a box or sphere, or set `dimensions` to 3");
                return None;
            }
            let (from, to) = (point("from", from), point("to", to));
            if from == to {
                report.problem(path, "`from` and `to` are one point", "move them apart, along the cylinder's axis");
                return None;
            }
            let radius = *radius;
            Some(Region::Cylinder { from, to, radius })
        }
        Shape::Mesh { file, placement } => {
            obstacles::mesh(path, file, placement, frame, folder, report).map(Region::Mesh)
        }
        Shape::Particles { .. } => None,
    }
}

/// Points of a lattice in the region's bounds, before any is made.
fn lattice_points(region: &Region, dimensions: Dimensions, spacing: f64) -> f64 {
    let size = match region {
        Region::Box { min, max } => *max - *min,
        Region::Sphere { radius, .. } => DVec3::splat(2.0 * radius),
        Region::Cylinder { from, to, radius } => (*to - *from).abs() + 2.0 * radius,
        Region::Mesh(mesh) => {
            let (low, high) = mesh.bounds();
            high - low
        }
    };
    (0..dimensions.count()).map(|axis| (size[axis] / spacing).max(1.0)).product()
}

#[allow(clippy::too_many_arguments, reason = "the context of one call, not a bundle with a life of its own")]
fn from_file(
    path: &str,
    file: &str,
    placement: &model::Placement,
    velocity: DVec3,
    body: &Body,
    frame: &Frame,
    folder: &Path,
    report: &mut Report,
) -> Option<Grains> {
    if body.spacing.is_some() || body.jitter != 0.0 || body.arrangement != Arrangement::default() {
        report.problem(
            path,
            "a particle file says itself where grains are",
            "remove `arrangement`, `spacing` and `jitter`",
        );
    }
    let loaded = match particle_file::load(&folder.join(file), frame.dimensions) {
        Ok(loaded) => loaded,
        Err(reason) => {
            report.problem(format!("{path}.file"), reason, FILE_MEND);
            return None;
        }
    };
    let (rotate, translate) = turn_and_place(path, placement, frame, report);
    let turned = |points: Vec<DVec3>, scale: f64, translate: DVec3| {
        let cloud = Mesh {
            vertices: points,
            triangles: Vec::new(),
        };
        cloud.placed(scale, rotate, translate).vertices
    };
    let position = turned(loaded.position, placement.scale, translate);
    let own = loaded.velocity.unwrap_or_else(|| vec![DVec3::ZERO; position.len()]);
    let own = turned(own, 1.0, DVec3::ZERO);
    let mut order: Vec<usize> = (0..position.len()).collect();
    if let Some(ids) = &loaded.id {
        order.sort_by_key(|&i| ids[i]);
    }
    Some(Grains {
        position: order.iter().map(|&i| position[i]).collect(),
        velocity: order.iter().map(|&i| own[i] + velocity).collect(),
    })
}

/// Grains that reach out of the domain: through a closed side at all, through an open one with their centers.
fn check_walls(path: &str, grains: &[DVec3], radius: f64, frame: &Frame, report: &mut Report) {
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
                Wall::Open => (center_beyond, "grains lie outside the domain's open side"),
                Wall::Contact | Wall::Clamp => (center_beyond + radius, "reaches through the domain's side"),
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
fn remove_inside_colliders(
    path: &str,
    grains: &mut Grains,
    colliders: &[Collider],
    radius: f64,
    dimensions: Dimensions,
    report: &mut Report,
) {
    for (i, collider) in colliders.iter().enumerate() {
        let offset = collider.path.first().map_or(DVec3::ZERO, |(_, offset)| offset.as_dvec3());
        let bounds = collider.shape.bounds();
        let reach = radius * (1.0 - TOLERANCE);
        let is_free = |position: &DVec3| {
            let point = *position - offset;
            let far = bounds.is_some_and(|(low, high)| {
                (low - point).max(point - high).max_element() >= reach
            });
            far || collider.shape.distance(point, dimensions) >= reach
        };
        let kept: Vec<bool> = grains.position.iter().map(is_free).collect();
        let (all, removed) = (kept.len(), kept.iter().filter(|kept| !**kept).count());
        grains.keep(&kept);
        lost(path, removed, all, &format!("colliders[{i}]"), report);
    }
}

/// Removes grains that overlap a grain of an earlier body.
fn remove_overlaps(path: &str, grains: &mut Grains, placed: &Placed, report: &mut Report) {
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
            format!("overlaps {other}: {removed} of its {all} grains"),
            "move one of them, or remove one",
        );
    } else if removed > 0 {
        report.notes.push(format!("{path}: {removed} of {all} grains overlap {other} and were left out"));
    }
}

/// Grains placed so far, by cells as wide as the least distance.
struct Placed {
    least_distance: f64,
    cells: HashMap<IVec3, Vec<(DVec3, usize)>>,
}

impl Placed {
    fn new(least_distance: f64) -> Self {
        Self {
            least_distance,
            cells: HashMap::new(),
        }
    }

    fn cell(&self, point: DVec3) -> IVec3 {
        (point / self.least_distance).floor().as_ivec3()
    }

    fn add(&mut self, points: &[DVec3], body: usize) {
        for point in points {
            let cell = self.cell(*point);
            self.cells.entry(cell).or_default().push((*point, body));
        }
    }

    /// The body whose grain is too near.
    fn body_at(&self, point: DVec3) -> Option<usize> {
        let home = self.cell(point);
        let neighbors = (0..27).map(|i| home + IVec3::new(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
        neighbors
            .filter_map(|cell| self.cells.get(&cell))
            .flatten()
            .find(|(other, _)| other.distance(point) < self.least_distance)
            .map(|(_, body)| *body)
    }
}
