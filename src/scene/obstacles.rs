//! Colliders: from the scene file to local coordinates, and which grains touch them.

use std::path::Path;

use glam::{DVec2, DVec3, Vec3};

use super::frame::{Frame, LARGEST_COORDINATE, Report};
use super::grain_materials;
use super::mesh::Mesh;
use super::mesh::surface::Surface;
use super::motion::{MOST_PIECES, Wave, smooth_path};
use super::text::number;
use super::{Collider, ColliderShape, Dimensions, color_maps, model};

/// All colliders, with their own motion until `end` (seconds); `schedule` adds what events move.
pub fn colliders(
    file: &model::SceneFile,
    frame: &Frame,
    folder: &Path,
    end: f64,
    report: &mut Report,
) -> Vec<Collider> {
    let mut colliders = Vec::new();
    for (i, given) in file.colliders.iter().enumerate() {
        let path = format!("colliders[{i}]");
        let twin = file.colliders[..i]
            .iter()
            .position(|other| other.name == given.name);
        if let (Some(twin), false) = (twin, given.name.is_empty()) {
            report.problem(
                format!("{path}.name"),
                format!("colliders[{twin}] has the same name"),
                "give each collider its own",
            );
        }
        let Some(shape) = shape(&format!("{path}.shape"), &given.shape, frame, folder, report) else {
            continue;
        };
        let color = color_maps::parse_hex(&given.color).unwrap_or_else(|| {
            report.problem(
                format!("{path}.color"),
                format!("\"{}\" is not a color", given.color),
                "write six hexadecimal digits: \"#8a8f98\"",
            );
            [0; 3]
        });
        colliders.push(Collider {
            name: given.name.clone(),
            path: motion(&path, given, file.radius(), end, frame, report),
            spin: spin(&shape, given.spin.unwrap_or(0.0)),
            material: grain_materials::number(
                &format!("{path}.material"),
                given.material.as_deref(),
                file,
                report,
            ),
            color: color.map(|channel| f32::from(channel) / 255.0),
            visible: given.visible,
            shape,
        });
    }
    colliders
}

/// The angular velocity of a surface that turns about the center or the axis of its shape, rad/s.
fn spin(shape: &ColliderShape, rate: f64) -> Vec3 {
    let axis = match shape {
        ColliderShape::Cylinder { from, to, .. } => (to - from).normalize_or_zero(),
        _ => Vec3::Z,
    };
    axis * rate as f32
}

fn motion(
    collider: &str,
    given: &model::Collider,
    radius: f64,
    end: f64,
    frame: &Frame,
    report: &mut Report,
) -> Vec<(f64, glam::Vec3)> {
    let points = &given.path;
    let path = format!("{collider}.path");
    let sound = report.problems.len();
    for (i, pair) in points.windows(2).enumerate() {
        if pair[1].at <= pair[0].at {
            report.problem(
                format!("{path}[{}].at", i + 1),
                format!(
                    "{} s is not after the point before, at {} s",
                    number(pair[1].at),
                    number(pair[0].at)
                ),
                "put the points in order of time",
            );
        }
    }
    let point = |(i, point): (usize, &model::PathPoint)| {
        let offset = report.vector(&format!("{path}[{i}].offset"), &point.offset, frame.dimensions);
        (point.at, offset)
    };
    let points: Vec<(f64, DVec3)> = points.iter().enumerate().map(point).collect();
    let wave = given.oscillation.as_ref().map(|wave| Wave {
        amplitude: report.vector(
            &format!("{collider}.oscillation.amplitude"),
            &wave.amplitude,
            frame.dimensions,
        ),
        period: wave.period,
        phase: wave.phase.to_radians(),
    });
    if report.problems.len() > sound {
        return Vec::new();
    }
    let spline = given.interpolation == model::Interpolation::Spline;
    match smooth_path(&points, spline, wave.as_ref(), radius, end) {
        Ok(path) => path,
        Err(pieces) => {
            let key = if wave.is_some() { "oscillation" } else { "path" };
            report.problem(
                format!("{collider}.{key}"),
                format!("this motion takes {} straight pieces", number(pieces)),
                format!(
                    "make it slower or smaller, or the run shorter: at most {MOST_PIECES} pieces are made"
                ),
            );
            Vec::new()
        }
    }
}

fn shape(
    path: &str,
    given: &model::ColliderShape,
    frame: &Frame,
    folder: &Path,
    report: &mut Report,
) -> Option<ColliderShape> {
    let sound = report.problems.len();
    let mut point = |key: &str, given: &model::Coordinates| {
        let point = report.vector(&format!("{path}.{key}"), given, frame.dimensions);
        frame.local(point)
    };
    let shape = match given {
        model::ColliderShape::Plane { point: at, normal } => {
            let at = point("point", at);
            let normal = report.vector(&format!("{path}.normal"), normal, frame.dimensions);
            let Some(normal) = normal.try_normalize() else {
                report.problem(
                    format!("{path}.normal"),
                    "has no length",
                    "point it out of the solid",
                );
                return None;
            };
            Some(ColliderShape::Plane {
                point: at.as_vec3(),
                normal: normal.as_vec3(),
            })
        }
        model::ColliderShape::Box { min, max } => {
            let (mut min, mut max) = (point("min", min), point("max", max));
            if frame.dimensions == Dimensions::Two {
                (min.z, max.z) = (0.0, 0.0);
            }
            check_corners(path, min, max, frame, report).then(|| ColliderShape::Box {
                min: min.as_vec3(),
                max: max.as_vec3(),
            })
        }
        model::ColliderShape::Sphere {
            center,
            radius,
            hollow,
        } => Some(ColliderShape::Sphere {
            center: point("center", center).as_vec3(),
            radius: *radius as f32,
            hollow: *hollow,
        }),
        model::ColliderShape::Cylinder {
            from,
            to,
            radius,
            hollow,
        } => {
            let (from, to) = (point("from", from), point("to", to));
            if frame.dimensions == Dimensions::Two {
                report.problem(
                    path,
                    "a cylinder in a 2D scene",
                    "use a sphere, which is a disc there",
                );
            } else if from == to {
                report.problem(path, "its two ends are the same point", "move one of them");
            }
            Some(ColliderShape::Cylinder {
                from: from.as_vec3(),
                to: to.as_vec3(),
                radius: *radius as f32,
                hollow: *hollow,
            })
        }
        model::ColliderShape::Mesh { file, placement } => {
            mesh(path, file, placement, frame, folder, report).map(ColliderShape::Mesh)
        }
    };
    shape.filter(|_| report.problems.len() == sound)
}

/// Whether a box's corners are in order; a problem if not.
pub fn check_corners(path: &str, min: DVec3, max: DVec3, frame: &Frame, report: &mut Report) -> bool {
    let wrong = frame.axes().find(|(axis, _)| min[*axis] >= max[*axis]);
    if let Some((_, name)) = wrong {
        report.problem(
            path,
            format!("min is not below max along {name}"),
            "swap them, or move one",
        );
    }
    wrong.is_none()
}

/// A closed mesh in local coordinates.
pub fn mesh(
    path: &str,
    file: &str,
    placement: &model::Placement,
    frame: &Frame,
    folder: &Path,
    report: &mut Report,
) -> Option<Mesh> {
    if frame.dimensions == Dimensions::Two {
        report.problem(
            path,
            "a mesh in a 2D scene",
            "use a box or sphere, or set `dimensions` to 3",
        );
        return None;
    }
    let sound = report.problems.len();
    let found = report.file(&format!("{path}.file"), folder, file)?;
    let mesh = match Mesh::load(&found) {
        Ok(mesh) => mesh,
        Err(reason) => {
            report.problem(format!("{path}.file"), reason, FILE_HELP);
            return None;
        }
    };
    let open = mesh.open_edges();
    if open > 0 {
        report.problem(
            format!("{path}.file"),
            format!("{file} is not closed: {open} edges have a triangle on one side only"),
            "close its holes in the program that made it (Blender: Mesh, Clean Up, Fill Holes)",
        );
        return None;
    }
    let (scale, rotate, translate) = transform(path, placement, frame, report);
    let mesh = mesh.placed(scale, rotate, translate);
    let (low, high) = mesh.bounds();
    if low.min(-high).min_element() < -LARGEST_COORDINATE {
        report.problem(
            format!("{path}.placement"),
            format!("the mesh reaches to {} m", number((-low).max(high).max_element())),
            format!(
                "make it smaller, or move it nearer: coordinates stay below {} m",
                number(LARGEST_COORDINATE)
            ),
        );
    }
    (report.problems.len() == sound).then_some(mesh)
}

pub const FILE_HELP: &str = "check the path, which is relative to the scene file, and the file itself";

/// Factors along the axes, degrees about them, and the move in local coordinates, metres.
pub fn transform(
    path: &str,
    placement: &model::Placement,
    frame: &Frame,
    report: &mut Report,
) -> (DVec3, DVec3, DVec3) {
    let place = format!("{path}.placement.stretch");
    let stretch = match &placement.stretch {
        None => DVec3::ONE,
        Some(factors) => report.vector(&place, factors, Dimensions::Three),
    };
    if stretch.cmple(DVec3::ZERO).any() {
        report.problem(
            place,
            "has a factor that is not above zero",
            "give three numbers above zero",
        );
    }
    let place = format!("{path}.placement.rotate");
    let rotate = match &placement.rotate {
        None => DVec3::ZERO,
        // The two dimensions' only axis is z, so a turn always has three numbers.
        Some(turn) => report.vector(&place, turn, Dimensions::Three),
    };
    if frame.dimensions == Dimensions::Two && (rotate.x != 0.0 || rotate.y != 0.0) {
        report.problem(
            place,
            "turns out of the plane of a 2D scene",
            "turn about z only: [0, 0, 30]",
        );
    }
    let translate = report.optional(
        &format!("{path}.placement.translate"),
        placement.translate.as_ref(),
        frame.dimensions,
    );
    (placement.scale * stretch, rotate, frame.local(translate))
}

/// A collider's shape, ready to be asked which grains touch it.
pub struct Obstacle<'a> {
    shape: &'a ColliderShape,
    /// Of a mesh.
    surface: Option<Surface>,
    dimensions: Dimensions,
}

impl<'a> Obstacle<'a> {
    pub fn new(shape: &'a ColliderShape, dimensions: Dimensions) -> Self {
        let surface = match shape {
            ColliderShape::Mesh(mesh) => Some(Surface::new(mesh)),
            _ => None,
        };
        Self {
            shape,
            surface,
            dimensions,
        }
    }

    /// Whether a point inside is at least `depth` below the surface of a plane, cylinder or mesh.
    pub fn is_deeper(&self, point: DVec3, depth: f64) -> bool {
        match self.shape {
            ColliderShape::Plane { .. } | ColliderShape::Cylinder { .. } => self.touches(point, -depth),
            ColliderShape::Mesh(_) => self
                .surface
                .as_ref()
                .is_some_and(|surface| surface.distance(point, depth) >= depth),
            _ => false,
        }
    }

    /// Where a point that lies inside comes out by the shortest way, if it is less than `limit` deep; metres.
    #[cfg(feature = "surface")]
    pub fn way_out(&self, at: DVec3, limit: f64) -> Option<DVec3> {
        let out = match self.shape {
            ColliderShape::Plane { point, normal } => {
                let normal = normal.as_dvec3();
                let height = normal.dot(at - point.as_dvec3());
                (height < 0.0).then(|| at - normal * height)?
            }
            ColliderShape::Box { min, max } => {
                let (min, max) = (min.as_dvec3(), max.as_dvec3());
                let depth = (at - min).min(max - at);
                if depth.min_element() <= 0.0 {
                    return None;
                }
                let axis = depth.min_position();
                let mut out = at;
                out[axis] = if at[axis] - min[axis] < max[axis] - at[axis] {
                    min[axis]
                } else {
                    max[axis]
                };
                out
            }
            ColliderShape::Sphere {
                center,
                radius,
                hollow,
            } => {
                let (center, radius) = (center.as_dvec3(), f64::from(*radius));
                let inside = (at.distance(center) < radius) != *hollow;
                inside.then(|| center + (at - center).normalize_or(DVec3::Y) * radius)?
            }
            ColliderShape::Cylinder {
                from,
                to,
                radius,
                hollow,
            } => {
                let depth = -distance_of_cylinder(at, [*from, *to], f64::from(*radius), *hollow);
                (depth > 0.0).then(|| out_of_cylinder(at, [*from, *to], f64::from(*radius), *hollow))?
            }
            ColliderShape::Mesh(_) => {
                let surface = self.surface.as_ref()?;
                surface.nearest(at, limit).filter(|_| surface.contains(at))?
            }
        };
        (out.distance(at) < limit).then_some(out)
    }

    /// Whether a ball of radius `reach` touches it, or lies inside.
    pub fn touches(&self, center: DVec3, reach: f64) -> bool {
        match self.shape {
            ColliderShape::Plane { point, normal } => {
                normal.as_dvec3().dot(center - point.as_dvec3()) < reach
            }
            ColliderShape::Box { min, max } => {
                let nearest = center.clamp(min.as_dvec3(), max.as_dvec3());
                let away = center - nearest;
                let away = match self.dimensions {
                    Dimensions::Two => away.with_z(0.0),
                    Dimensions::Three => away,
                };
                away.length() < reach
            }
            ColliderShape::Sphere {
                center: middle,
                radius,
                hollow,
            } => {
                let (distance, radius) = (center.distance(middle.as_dvec3()), f64::from(*radius));
                if *hollow {
                    distance > radius - reach
                } else {
                    distance < radius + reach
                }
            }
            ColliderShape::Cylinder {
                from,
                to,
                radius,
                hollow,
            } => distance_of_cylinder(center, [*from, *to], f64::from(*radius), *hollow) < reach,
            ColliderShape::Mesh(_) => self
                .surface
                .as_ref()
                .is_some_and(|surface| surface.distance(center, reach) < reach || surface.contains(center)),
        }
    }
}

/// The point of the surface that is nearest to one in what is solid.
#[cfg(feature = "surface")]
fn out_of_cylinder(point: DVec3, ends: [Vec3; 2], radius: f64, hollow: bool) -> DVec3 {
    let [from, to] = ends.map(|end| end.as_dvec3());
    let axis = (to - from).normalize();
    let along = axis.dot(point - from);
    let away = point - from - along * axis;
    let beside = away.normalize_or(axis.any_orthonormal_vector()) * (radius - away.length());
    let length = from.distance(to);
    let beyond = if along < length / 2.0 {
        -along
    } else {
        length - along
    };
    match !hollow && beyond.abs() < beside.length() {
        true => point + beyond * axis,
        false => point + beside,
    }
}

/// Of a point from the surface, metres, less than zero in what is solid.
fn distance_of_cylinder(point: DVec3, ends: [Vec3; 2], radius: f64, hollow: bool) -> f64 {
    let [from, to] = ends.map(|end| end.as_dvec3());
    let axis = (to - from).normalize();
    let along = axis.dot(point - from);
    let beside = (point - from - along * axis).length() - radius;
    if hollow {
        return -beside;
    }
    let beyond = (-along).max(along - from.distance(to));
    let outside = DVec2::new(beside, beyond).max(DVec2::ZERO).length();
    outside + beside.max(beyond).min(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::mesh::samples::cube;

    #[test]
    fn a_box_of_triangles_is_a_box() {
        let (min, max) = (DVec3::new(-1.0, 0.0, 0.5), DVec3::new(0.5, 2.0, 1.0));
        let triangles = ColliderShape::Mesh(cube(min, max));
        let exact = ColliderShape::Box {
            min: min.as_vec3(),
            max: max.as_vec3(),
        };
        let [triangles, exact] = [&triangles, &exact].map(|shape| Obstacle::new(shape, Dimensions::Three));
        let ticks = [-1.7, -0.9, -0.3, 0.4, 0.6, 0.9, 1.3, 2.2];
        for reach in [0.05, 0.3, 0.7] {
            let mut touching = 0;
            for (x, y, z) in (0..512).map(|i| (ticks[i % 8], ticks[i / 8 % 8], ticks[i / 64])) {
                let point = DVec3::new(x, y, z);
                let expected = exact.touches(point, reach);
                assert_eq!(triangles.touches(point, reach), expected, "{point}, {reach}");
                touching += usize::from(expected);
            }
            assert!(touching >= 3 * 4 * 2);
        }
    }

    #[cfg(feature = "surface")]
    #[test]
    fn what_lies_inside_comes_out_by_the_shortest_way() {
        let (min, max) = (DVec3::new(-1.0, 0.0, 0.5), DVec3::new(0.5, 2.0, 1.0));
        let plane = ColliderShape::Plane {
            point: glam::Vec3::new(0.0, 2.0, 0.0),
            normal: glam::Vec3::Y,
        };
        let block = ColliderShape::Box {
            min: min.as_vec3(),
            max: max.as_vec3(),
        };
        let triangles = ColliderShape::Mesh(cube(min, max));
        let ball = |hollow| ColliderShape::Sphere {
            center: glam::Vec3::ZERO,
            radius: 2.0,
            hollow,
        };
        let out = |shape: &ColliderShape, point: [f64; 3]| {
            Obstacle::new(shape, Dimensions::Three).way_out(point.into(), 0.2)
        };
        let top = Some(DVec3::new(0.0, 2.0, 0.75));
        for shape in [&plane, &block, &triangles] {
            assert_eq!(out(shape, [0.0, 1.9, 0.75]), top);
            assert_eq!(out(shape, [0.0, 2.1, 0.75]), None, "it is outside");
        }
        assert_eq!(out(&block, [-0.3, 1.0, 0.75]), None, "it is 0.25 deep");
        let (inner, outer) = ([0.0, 1.9, 0.0], [0.0, 2.1, 0.0]);
        for (hollow, inside, outside) in [(false, inner, outer), (true, outer, inner)] {
            let foot = out(&ball(hollow), inside).unwrap();
            assert!(foot.distance(DVec3::new(0.0, 2.0, 0.0)) < 1e-12, "{foot}");
            assert_eq!(out(&ball(hollow), outside), None);
        }
    }

    fn cylinder(hollow: bool) -> ColliderShape {
        ColliderShape::Cylinder {
            from: Vec3::new(1.0, 1.0, 0.0),
            to: Vec3::new(1.0, 1.0, 2.0),
            radius: 0.5,
            hollow,
        }
    }

    #[test]
    fn a_cylinder_touches_what_is_beside_it() {
        let (full, hollow) = (cylinder(false), cylinder(true));
        let [full, hollow] = [&full, &hollow].map(|shape| Obstacle::new(shape, Dimensions::Three));
        let beside = DVec3::new(1.75, 1.0, 1.0);
        assert!(full.touches(beside, 0.26) && !full.touches(beside, 0.24) && hollow.is_deeper(beside, 0.24));
        let above = DVec3::new(1.0, 1.3, 2.5);
        assert!(full.touches(above, 0.51) && !full.touches(above, 0.49));
        assert!(hollow.touches(above, 0.21) && !hollow.touches(above, 0.19));
        assert!(full.is_deeper(DVec3::ONE, 0.49) && !full.is_deeper(DVec3::ONE, 0.51));
    }

    #[test]
    #[cfg(feature = "surface")]
    fn the_shortest_way_out_of_a_cylinder_is_found() {
        let (full, hollow) = (cylinder(false), cylinder(true));
        let [full, hollow] = [&full, &hollow].map(|shape| Obstacle::new(shape, Dimensions::Three));
        let is = |found: Option<DVec3>, x: f64, y: f64, z: f64| {
            assert!(found.unwrap().distance(DVec3::new(x, y, z)) < 1e-6, "{found:?}");
        };
        is(full.way_out(DVec3::new(1.4, 1.0, 1.0), 1.0), 1.5, 1.0, 1.0);
        is(full.way_out(DVec3::new(1.1, 1.0, 1.9), 1.0), 1.1, 1.0, 2.0);
        is(hollow.way_out(DVec3::new(1.0, 1.75, 5.0), 1.0), 1.0, 1.5, 5.0);
        assert_eq!(full.way_out(DVec3::new(1.6, 1.0, 1.0), 1.0), None);
        assert_eq!(hollow.way_out(DVec3::ONE, 1.0), None);
        assert_eq!(full.way_out(DVec3::new(1.2, 1.0, 1.0), 0.2), None);
    }

    #[test]
    fn a_flat_box_touches_what_is_beside_it() {
        let shape = ColliderShape::Box {
            min: glam::Vec3::ZERO,
            max: glam::Vec3::new(2.0, 1.0, 0.0),
        };
        let flat = Obstacle::new(&shape, Dimensions::Two);
        let touches = |x: f64, y: f64, reach: f64| flat.touches(DVec3::new(x, y, 0.0), reach);
        assert!(touches(1.0, 0.75, 0.01));
        assert!(touches(1.0, 1.5, 0.51) && !touches(1.0, 1.5, 0.49));
        assert!(touches(5.0, 5.0, 5.01) && !touches(5.0, 5.0, 4.99));
    }
}
