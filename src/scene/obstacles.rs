//! Colliders: from the scene file to local coordinates, and how far a point is from them.

use std::f64::consts::PI;
use std::path::Path;

use glam::DVec3;

use super::frame::{Frame, Report};
use super::mesh::Mesh;
use super::text::number;
use super::{Collider, ColliderShape, Dimensions, color_maps, model};

/// All colliders, with their motion along their own paths; `schedule` adds what events move.
pub fn colliders(file: &model::SceneFile, frame: &Frame, folder: &Path, report: &mut Report) -> Vec<Collider> {
    let mut colliders = Vec::new();
    for (i, given) in file.colliders.iter().enumerate() {
        let path = format!("colliders[{i}]");
        let twin = file.colliders[..i].iter().position(|other| other.name == given.name);
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
            shape,
            path: motion(&format!("{path}.path"), &given.path, frame, report),
            color: color.map(|channel| f32::from(channel) / 255.0),
            visible: given.visible,
        });
    }
    colliders
}

fn motion(path: &str, points: &[model::PathPoint], frame: &Frame, report: &mut Report) -> Vec<(f64, glam::Vec3)> {
    for (i, pair) in points.windows(2).enumerate() {
        if pair[1].at <= pair[0].at {
            report.problem(
                format!("{path}[{}].at", i + 1),
                format!("{} s is not after the point before, at {} s", number(pair[1].at), number(pair[0].at)),
                "put the points in order of time",
            );
        }
    }
    let point = |(i, point): (usize, &model::PathPoint)| {
        let offset = report.vector(&format!("{path}[{i}].offset"), &point.offset, frame.dimensions);
        (point.at, offset.as_vec3())
    };
    points.iter().enumerate().map(point).collect()
}

fn shape(
    path: &str,
    given: &model::ColliderShape,
    frame: &Frame,
    folder: &Path,
    report: &mut Report,
) -> Option<ColliderShape> {
    let mut point = |key: &str, given: &model::Coordinates| {
        let point = report.vector(&format!("{path}.{key}"), given, frame.dimensions);
        frame.local(point)
    };
    match given {
        model::ColliderShape::Plane { point: at, normal } => {
            let at = point("point", at);
            let normal = report.vector(&format!("{path}.normal"), normal, frame.dimensions);
            let Some(normal) = normal.try_normalize() else {
                report.problem(format!("{path}.normal"), "has no length", "point it out of the solid");
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
        model::ColliderShape::Sphere { center, radius } => Some(ColliderShape::Sphere {
            center: point("center", center).as_vec3(),
            radius: *radius as f32,
        }),
        model::ColliderShape::Mesh { file, placement } => {
            mesh(path, file, placement, frame, folder, report).map(ColliderShape::Mesh)
        }
    }
}

/// Whether a box's corners are in order; a problem if not.
pub fn check_corners(path: &str, min: DVec3, max: DVec3, frame: &Frame, report: &mut Report) -> bool {
    let wrong = frame.axes().find(|(axis, _)| min[*axis] >= max[*axis]);
    if let Some((_, name)) = wrong {
        report.problem(path, format!("min is not below max along {name}"), "swap them, or move one");
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
        report.problem(path, "a mesh in a 2D scene", "use a box or sphere, or set `dimensions` to 3");
        return None;
    }
    let mesh = match Mesh::load(&folder.join(file)) {
        Ok(mesh) => mesh,
        Err(reason) => {
            report.problem(format!("{path}.file"), reason, FILE_MEND);
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
    let (rotate, translate) = turn_and_place(path, placement, frame, report);
    Some(mesh.placed(placement.scale, rotate, translate))
}

pub const FILE_MEND: &str = "check the path, which is relative to the scene file, and the file itself";

/// Degrees about the axes, and the move in local coordinates, metres.
pub fn turn_and_place(path: &str, placement: &model::Placement, frame: &Frame, report: &mut Report) -> (DVec3, DVec3) {
    let place = format!("{path}.placement.rotate");
    let rotate = match &placement.rotate {
        None => DVec3::ZERO,
        // The two dimensions' only axis is z, so a turn always has three numbers.
        Some(turn) => report.vector(&place, turn, Dimensions::Three),
    };
    if frame.dimensions == Dimensions::Two && (rotate.x != 0.0 || rotate.y != 0.0) {
        report.problem(place, "turns out of the plane of a 2D scene", "turn about z only: [0, 0, 30]");
    }
    let translate = report.optional(
        &format!("{path}.placement.translate"),
        placement.translate.as_ref(),
        frame.dimensions,
    );
    (rotate, frame.local(translate))
}

impl ColliderShape {
    /// Corners of the box around a shape that is dear to measure; cheap shapes need none.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        match self {
            Self::Mesh(mesh) => Some(mesh.bounds()),
            _ => None,
        }
    }

    /// Signed distance from the surface, metres: negative inside.
    pub fn distance(&self, point: DVec3, dimensions: Dimensions) -> f64 {
        match self {
            Self::Plane { point: at, normal } => normal.as_dvec3().dot(point - at.as_dvec3()),
            Self::Box { min, max } => {
                let (min, max) = (min.as_dvec3(), max.as_dvec3());
                let mut beyond = (min - point).max(point - max);
                if dimensions == Dimensions::Two {
                    beyond.z = beyond.x.max(beyond.y);
                    let outside = beyond.truncate().max(glam::DVec2::ZERO).length();
                    return outside + beyond.max_element().min(0.0);
                }
                beyond.max(DVec3::ZERO).length() + beyond.max_element().min(0.0)
            }
            Self::Sphere { center, radius } => point.distance(center.as_dvec3()) - f64::from(*radius),
            Self::Mesh(mesh) => mesh_distance(mesh, point),
        }
    }
}

/// By the distance to every triangle, and the winding number for the sign (Jacobson 2013).
fn mesh_distance(mesh: &Mesh, point: DVec3) -> f64 {
    let mut nearest = f64::INFINITY;
    let mut solid_angle = 0.0;
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|i| mesh.vertices[i as usize] - point);
        nearest = nearest.min(nearest_to_origin(a, b, c).length());
        // van Oosterom and Strackee 1983.
        let (la, lb, lc) = (a.length(), b.length(), c.length());
        let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        solid_angle += 2.0 * a.dot(b.cross(c)).atan2(below);
    }
    if solid_angle.abs() > 2.0 * PI { -nearest } else { nearest }
}

/// The point of a triangle that is nearest to zero (Ericson 2005, section 5.1.5).
fn nearest_to_origin(a: DVec3, b: DVec3, c: DVec3) -> DVec3 {
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (-ab.dot(a), -ac.dot(a));
    let (d3, d4) = (-ab.dot(b), -ac.dot(b));
    let (d5, d6) = (-ab.dot(c), -ac.dot(c));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    a + ab * (vb / (va + vb + vc)) + ac * (vc / (va + vb + vc))
}
