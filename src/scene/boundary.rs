//! Boundary particles: layers of particles inside of walls and obstacles, which carry a fluid's pressure and velocity
//! on (Adami 2012).

use glam::{DVec3, Vec3};

use super::frame::{Frame, Report};
use super::model::{SceneFile, Wall};
use super::obstacles::Obstacle;
use super::shapes;
use super::text::number;
use super::{Collider, Dimensions};

/// Boundary particles; they follow the fluid's on the device and in ids.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct BoundaryParticles {
    /// Local, metres, at time zero.
    pub position: Vec<Vec3>,
    /// Velocity of the surface besides its body's motion, m/s.
    pub surface_velocity: Vec<Vec3>,
    /// Index of the collider that each belongs to, or of the rigid body behind all colliders; `NO_BODY` for the domain's
    /// sides.
    pub body: Vec<u32>,
    /// How far they reach beyond the domain's sides, metres.
    pub depth: f64,
    /// `[axis][end]`: velocity of the surface of each of the domain's sides, m/s.
    pub side_velocity: [[Vec3; 2]; 3],
}

/// Of boundary particles that belong to the domain's sides, which never move.
pub const NO_BODY: u32 = u32::MAX;

impl BoundaryParticles {
    pub fn len(&self) -> usize {
        self.position.len()
    }

    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }
}

/// Samples every side with `particles` and every collider, as deep as the kernel reaches.
pub fn sample(
    file: &SceneFile,
    frame: &Frame,
    colliders: &[Collider],
    support: f64,
    report: &mut Report,
) -> BoundaryParticles {
    let spacing = 2.0 * file.radius();
    let layers = layers(support, spacing);
    let mut boundary = BoundaryParticles {
        depth: layers * spacing,
        ..BoundaryParticles::default()
    };
    domain_sides(file, frame, spacing, layers as i64, &mut boundary, report);
    for (index, collider) in colliders.iter().enumerate() {
        let depth = boundary.depth;
        let place = format!("colliders[{index}].shape");
        let count = most_inside(collider, frame, spacing, depth);
        let help = "make it smaller, or fluid.spacing larger; a plane takes the fewest";
        if !report.room_for(&place, "takes about", count, "boundary particles", help) {
            continue;
        }
        for point in inside(collider, frame, spacing, depth) {
            let center = match &collider.shape {
                super::ColliderShape::Sphere { center, .. } => *center,
                super::ColliderShape::Cylinder { from, .. } => *from,
                _ => Vec3::ZERO,
            };
            let turn = collider.spin.as_dvec3().cross(point - center.as_dvec3());
            boundary.position.push(point.as_vec3());
            boundary.surface_velocity.push(turn.as_vec3());
            boundary.body.push(index as u32);
        }
    }
    boundary
}

/// Layers of particles that a kernel reaches.
pub(super) fn layers(support: f64, spacing: f64) -> f64 {
    (support / spacing - 1e-9).ceil()
}

/// A lattice that goes on from the fluid's: its points stand half a spacing off the sides.
fn domain_sides(
    file: &SceneFile,
    frame: &Frame,
    spacing: f64,
    layers: i64,
    boundary: &mut BoundaryParticles,
    report: &mut Report,
) {
    let velocities = file.domain.side_velocities.all();
    let velocity = [0, 1, 2].map(|axis: usize| {
        [0, 1].map(|end: usize| {
            let (name, given) = velocities[axis][end];
            let path = format!("domain.side_velocities.{name}");
            let velocity = report.optional(&path, given, frame.dimensions);
            if given.is_some() && !matches!(frame.sides[axis][end], Wall::Particles | Wall::Planes) {
                let help = format!("leave it out, or set domain.sides.{name} to `particles` or `planes`");
                report.problem(path, "this side has no surface that could move", help);
            }
            velocity
        })
    });
    boundary.side_velocity = velocity.map(|ends| ends.map(|v| v.as_vec3()));
    let mut first = [0i64; 3];
    let mut last = [1i64; 3];
    let mut step = [0.0; 3];
    for (axis, _) in frame.axes() {
        let length = frame.max[axis] - frame.min[axis];
        let count = (length / spacing).round().max(1.0);
        // Along an axis whose length is no multiple of the spacing, points stand a little nearer or farther.
        step[axis] = length / count;
        last[axis] = count as i64;
        if frame.sides[axis][0] == Wall::Particles {
            first[axis] = -layers;
        }
        if frame.sides[axis][1] == Wall::Particles {
            last[axis] += layers;
        }
    }
    let cells = [0, 1, 2]
        .map(|axis: usize| (step[axis] > 0.0).then(|| (frame.max[axis] - frame.min[axis]) / step[axis]));
    let place = |axis: usize, tick: i64| match cells[axis] {
        Some(count) if tick as f64 >= count - 0.5 => {
            frame.max[axis] + (tick as f64 - count.round() + 0.5) * spacing
        }
        Some(_) if tick < 0 => frame.min[axis] + (tick as f64 + 0.5) * spacing,
        Some(_) => frame.min[axis] + (tick as f64 + 0.5) * step[axis],
        None => 0.0,
    };
    let beyond = |axis: usize, tick: i64| match cells[axis] {
        Some(_) if tick < 0 => Some(0),
        Some(count) if tick as f64 >= count - 0.5 => Some(1),
        _ => None,
    };
    let all: f64 = (0..3).map(|axis| (last[axis] - first[axis]) as f64).product();
    let inside: f64 = cells.iter().map(|count| count.map_or(1.0, f64::round)).product();
    let help = "make the domain smaller, or fluid.spacing larger; sides that are `planes` take none";
    if !report.room_for(
        "domain.sides",
        "take about",
        all - inside,
        "boundary particles",
        help,
    ) {
        return;
    }
    // Ticks along an axis; where there is nothing to find between the sides, those beyond them alone.
    let ticks = |axis: usize, all: bool| {
        let end = cells[axis].map_or(last[axis], |count| (count - 0.5).ceil() as i64);
        let (low, high) = if all {
            (first[axis]..end, end..last[axis])
        } else {
            (first[axis]..0, end..last[axis])
        };
        low.chain(high)
    };
    let is_between = |axis: usize, tick: i64| beyond(axis, tick).is_none();
    let has_sides = |axis: usize| ticks(axis, false).next().is_some();
    for y in ticks(1, has_sides(0) || has_sides(2)) {
        for z in ticks(2, has_sides(0) || !is_between(1, y)) {
            for x in ticks(0, !is_between(1, y) || !is_between(2, z)) {
                let tick = [x, y, z];
                let sides: Vec<(usize, usize)> = (0..3)
                    .filter_map(|axis| beyond(axis, tick[axis]).map(|end| (axis, end)))
                    .collect();
                if sides.is_empty() {
                    continue;
                }
                let point = DVec3::from([0, 1, 2].map(|axis| place(axis, tick[axis])));
                // In an edge or a corner, a side that slides along itself keeps its velocity to itself.
                let slides = match sides[..] {
                    [(axis, end)] => velocity[axis][end],
                    _ => DVec3::ZERO,
                };
                boundary.position.push(point.as_vec3());
                boundary.surface_velocity.push(slides.as_vec3());
                boundary.body.push(NO_BODY);
            }
        }
    }
    let uneven = frame.axes().find(|(axis, _)| {
        let periodic = frame.sides[*axis][0] == Wall::Periodic;
        periodic && (step[*axis] / spacing - 1.0).abs() > 1e-3
    });
    if let Some((axis, name)) = uneven {
        report.notes.push(format!(
            "the domain's {name} extent is {} spacings; a fluid that fills it is not evenly spread",
            number((frame.max[axis] - frame.min[axis]) / spacing)
        ));
    }
}

/// About how many points [`inside`] makes or goes through, at most.
fn most_inside(collider: &Collider, frame: &Frame, spacing: f64, depth: f64) -> f64 {
    use super::ColliderShape::*;
    let axes = frame.dimensions.count();
    let along = |extent: DVec3| -> f64 {
        (0..axes)
            .map(|axis| (extent[axis] / spacing).max(0.0) + 1.0)
            .product()
    };
    match &collider.shape {
        Box { min, max } => {
            let (min, max) = (min.as_dvec3(), max.as_dvec3());
            along(max - min) - (along(max - min - 2.0 * depth - 2.0 * spacing)).max(0.0)
        }
        Sphere { radius, hollow, .. } => {
            let outer = f64::from(*radius) + if *hollow { depth } else { 0.0 };
            let layers = (depth / spacing).round();
            let sphere = match frame.dimensions {
                Dimensions::Two => std::f64::consts::TAU * outer / spacing,
                Dimensions::Three => 4.0 * std::f64::consts::PI * (outer / spacing).powi(2),
            };
            layers * (sphere + 1.0)
        }
        Plane { .. } | Cylinder { .. } => {
            let (low, high) = shell_bounds(collider, frame, depth);
            let widest = (high - low).truncate().max_element().max((high - low).z);
            2.0 * (depth / spacing + 1.0) * (widest / spacing).powi(axes as i32 - 1)
        }
        Mesh(mesh) => {
            let (low, high) = shell_bounds(collider, frame, depth);
            let corner = |index: u32| mesh.vertices[index as usize];
            let areas = mesh
                .triangles
                .iter()
                .map(|&[a, b, c]| 0.5 * (corner(b) - corner(a)).cross(corner(c) - corner(a)).length());
            let shell = 2.0 * (areas.sum::<f64>() / (spacing * spacing) + 1.0) * (depth / spacing + 1.0);
            let all = along(high - low);
            if all > MOST_TRIED {
                f64::INFINITY
            } else {
                all.min(shell)
            }
        }
    }
}

/// Points of a lattice that are held against a mesh; more take minutes.
const MOST_TRIED: f64 = 5e7;

/// The box that [`lattice_shell`] goes through.
fn shell_bounds(collider: &Collider, frame: &Frame, depth: f64) -> (DVec3, DVec3) {
    let around = DVec3::splat(depth);
    match &collider.shape {
        super::ColliderShape::Mesh(mesh) => {
            let (low, high) = mesh.bounds();
            (low.max(frame.min - around), high.min(frame.max + around))
        }
        _ => (frame.min - around, frame.max + around),
    }
}

/// Points inside of an obstacle, no deeper than `depth` below its surface and inside the domain, where fluid can be.
fn inside(collider: &Collider, frame: &Frame, spacing: f64, depth: f64) -> Vec<DVec3> {
    use super::ColliderShape::*;
    let offset = collider
        .path
        .first()
        .map_or(DVec3::ZERO, |(_, offset)| offset.as_dvec3());
    let points = match &collider.shape {
        Box { min, max } => box_shell(min.as_dvec3(), max.as_dvec3(), frame.dimensions, spacing, depth),
        Sphere {
            center,
            radius,
            hollow,
        } => sphere_shells(
            center.as_dvec3(),
            f64::from(*radius),
            *hollow,
            frame.dimensions,
            spacing,
            depth,
        ),
        Plane { .. } | Cylinder { .. } | Mesh(_) => lattice_shell(collider, frame, spacing, depth),
    };
    points.into_iter().map(|point| point + offset).collect()
}

/// Points of a box's own lattice, half a spacing below its faces.
pub(super) fn box_shell(
    min: DVec3,
    max: DVec3,
    dimensions: Dimensions,
    spacing: f64,
    depth: f64,
) -> Vec<DVec3> {
    let axes = dimensions.count();
    let mut ticks: [Vec<f64>; 3] = [vec![0.0], vec![0.0], vec![0.0]];
    for (axis, ticks) in ticks.iter_mut().enumerate().take(axes) {
        let length = max[axis] - min[axis];
        let count = (length / spacing).round().max(1.0);
        *ticks = (0..count as i64)
            .map(|k| min[axis] + (k as f64 + 0.5) * length / count)
            .collect();
    }
    let below = |point: DVec3, axis: usize| (point[axis] - min[axis]).min(max[axis] - point[axis]);
    // Of a row deep inside, the ends alone lie near a face.
    let near = |x: &f64| below(DVec3::splat(*x), 0) < depth;
    let first_deep = ticks[0].iter().take_while(|x| near(x)).count();
    let last_deep = ticks[0].len()
        - ticks[0][first_deep..]
            .iter()
            .rev()
            .take_while(|x| near(x))
            .count();
    let mut points = Vec::new();
    for &y in &ticks[1] {
        for &z in &ticks[2] {
            let row = DVec3::new(0.0, y, z);
            let is_deep = (1..axes).all(|axis| below(row, axis) >= depth);
            let skipped = if is_deep { first_deep..last_deep } else { 0..0 };
            let xs = ticks[0][..skipped.start].iter().chain(&ticks[0][skipped.end..]);
            points.extend(xs.map(|&x| row.with_x(x)));
        }
    }
    points
}

/// Rings in 2D, Fibonacci spheres in 3D, one spacing apart, below the surface of what is solid.
pub(super) fn sphere_shells(
    center: DVec3,
    radius: f64,
    hollow: bool,
    dimensions: Dimensions,
    spacing: f64,
    depth: f64,
) -> Vec<DVec3> {
    let layers = (depth / spacing).round() as u32;
    let fitting = if hollow {
        layers
    } else {
        layers.min((radius / spacing).ceil() as u32)
    };
    let shells = (0..fitting).map(|layer| {
        let below = (f64::from(layer) + 0.5) * spacing;
        if hollow { radius + below } else { radius - below }
    });
    let shells = shells.filter(|&r| r > 0.0);
    match dimensions {
        Dimensions::Two => shells
            .flat_map(|r| shapes::rings(center, r, 1, spacing))
            .collect(),
        Dimensions::Three => shells
            .flat_map(|r| fibonacci_sphere(center, r, spacing))
            .collect(),
    }
}

fn fibonacci_sphere(center: DVec3, radius: f64, spacing: f64) -> impl Iterator<Item = DVec3> {
    use std::f64::consts::PI;
    let count = (4.0 * PI * radius * radius / (spacing * spacing))
        .round()
        .max(1.0);
    let golden = PI * (5f64.sqrt() - 1.0);
    (0..count as u32).map(move |k| {
        let y = 1.0 - 2.0 * (f64::from(k) + 0.5) / count;
        let (sin, cos) = (golden * f64::from(k)).sin_cos();
        let ring = (1.0 - y * y).max(0.0).sqrt();
        center + radius * DVec3::new(cos * ring, y, sin * ring)
    })
}

/// Points of the fluid's lattice inside of a plane's, cylinder's or mesh's solid.
fn lattice_shell(collider: &Collider, frame: &Frame, spacing: f64, depth: f64) -> Vec<DVec3> {
    let obstacle = Obstacle::new(&collider.shape, frame.dimensions);
    let (low, high) = shell_bounds(collider, frame, depth);
    let ticks = |axis: usize| -> Vec<f64> {
        if axis >= frame.dimensions.count() {
            return vec![0.0];
        }
        let first = ((low[axis] - frame.min[axis]) / spacing).floor() as i64;
        let last = ((high[axis] - frame.min[axis]) / spacing).ceil() as i64;
        (first..last)
            .map(|k| frame.min[axis] + (k as f64 + 0.5) * spacing)
            .collect()
    };
    let [xs, ys, zs] = [ticks(0), ticks(1), ticks(2)];
    let mut points = Vec::new();
    for &y in &ys {
        for &z in &zs {
            let row = DVec3::new(0.0, y, z);
            for &x in &xs[near_plane(&collider.shape, row, &xs, depth)] {
                let point = row.with_x(x);
                if obstacle.touches(point, 0.0) && !obstacle.is_deeper(point, depth) {
                    points.push(point);
                }
            }
        }
    }
    points
}

/// Places in a row along x that can lie in a plane's solid and no deeper than `depth`; all of them for other shapes.
fn near_plane(shape: &super::ColliderShape, row: DVec3, xs: &[f64], depth: f64) -> std::ops::Range<usize> {
    let super::ColliderShape::Plane { point, normal } = shape else {
        return 0..xs.len();
    };
    let (point, normal) = (point.as_dvec3(), normal.as_dvec3());
    let (Some(&first), Some(&last)) = (xs.first(), xs.last()) else {
        return 0..0;
    };
    let height = |x: f64| normal.dot(row.with_x(x) - point);
    // Heights rise or fall along the row, so that those in question stand side by side; rounding is given some room.
    let room = 1e-6 * depth;
    let is_in = |x: f64| (-depth - room..room).contains(&height(x));
    let rises = height(last) > height(first);
    let before = |limit: f64| {
        xs.partition_point(|&x| {
            if rises {
                height(x) < limit
            } else {
                height(x) > limit
            }
        })
    };
    match rises {
        true => before(-depth - room)..before(room),
        false if height(first) == height(last) && !is_in(first) => 0..0,
        false => before(room)..before(-depth - room),
    }
}
