//! Rigid bodies in a fluid: their surfaces, and the boundary particles below these (Akinci et al. 2012).

use std::path::Path;
use std::sync::Arc;

use glam::{DVec3, Vec3};

use super::bodies;
use super::boundary::{self, BoundaryParticles};
use super::color_maps;
use super::fit::{self, Grains, Placed};
use super::frame::{Frame, Report};
use super::model::{Body, FluidSolver, Rigid, SceneFile, Shape, StartPressure};
use super::obstacles::Obstacle;
use super::rigid::RigidBody;
use super::rigid::solid::Solid;
use super::shapes::Region;
use super::{Collider, ColliderShape, Dimensions, Scene};

/// Wood.
const USUAL_COLOR: [u8; 3] = [0xb5, 0x81, 0x4e];
/// Particles of two bodies may stand as near as this at the start, in spacings: turned lattices never fit exactly.
const NEAREST: f64 = 0.8;

/// Radians by which the springs of contacts swing in a step (`shaders/physics/dfsph/bodies/begin.wgsl`), of a body that is hit at
/// its center; a corner is up to six times lighter.
pub const CONTACT_RATE: f64 = 0.4;
/// How far a body that lies on another one may sink into it, in spacings. With 0.04, bodies in a pile were pressed through walls.
const SAG: f64 = 0.02;

/// The longest step with which bodies lie firmly on each other, seconds.
pub fn contact_step(spacing: f64, gravity: f64) -> f64 {
    CONTACT_RATE * (SAG * spacing / gravity).sqrt()
}

/// The flag of shaders that know rigid bodies in a fluid.
pub const FLAG: &str = "floating_bodies";

/// Whether the scene has rigid bodies in a fluid.
pub fn are_in(scene: &Scene) -> bool {
    scene.fluid().is_some() && !scene.rigid_bodies.is_empty()
}

/// Boundary particles that rigid bodies in a fluid are made of; they are the first ones.
pub fn members(scene: &Scene) -> u64 {
    match are_in(scene) {
        true => scene
            .rigid_bodies
            .iter()
            .map(|body| body.places.len() as u64)
            .sum(),
        false => 0,
    }
}

/// What a rigid body in a fluid looks like.
#[derive(Debug, Clone)]
pub struct Surface {
    /// In the body's own axes, around its center of mass, metres.
    pub shape: ColliderShape,
    /// sRGB, 0 to 1.
    pub color: [f32; 3],
}

/// The surface of a body, and the solid in it where it is written, without particles.
pub fn surface(
    path: &str,
    body: &Body,
    rigid: &Rigid,
    frame: &Frame,
    folder: &Path,
    report: &mut Report,
) -> Option<(Arc<Surface>, Solid)> {
    let shape = format!("{path}.shape");
    if matches!(body.shape, Shape::Ring { .. } | Shape::Particles { .. }) {
        report.problem(
            shape,
            "a rigid body in a fluid needs a surface that is known",
            "use a box or a sphere, in 3D a cylinder or a mesh too",
        );
        return None;
    }
    let color = match rigid.color.as_deref() {
        None => USUAL_COLOR,
        Some(given) => color_maps::parse_hex(given).unwrap_or_else(|| {
            report.problem(
                format!("{path}.rigid.color"),
                format!("\"{given}\" is not a color"),
                "write six hexadecimal digits: \"#b5814e\"",
            );
            USUAL_COLOR
        }),
    };
    let region = bodies::region(&shape, &body.shape, frame, folder, report)?;
    let solid = Solid::of_region(&region, frame.dimensions)?;
    let around = |at: DVec3| (at - solid.center).as_vec3();
    let shape = match region {
        Region::Box { min, max } => ColliderShape::Box {
            min: around(min),
            max: around(max),
        },
        Region::Sphere { center, radius } => ColliderShape::Sphere {
            center: around(center),
            radius: radius as f32,
            hollow: false,
        },
        Region::Cylinder { from, to, radius } => ColliderShape::Cylinder {
            from: around(from),
            to: around(to),
            radius: radius as f32,
            hollow: false,
        },
        Region::Mesh(mut mesh) => {
            for vertex in &mut mesh.vertices {
                *vertex -= solid.center;
            }
            ColliderShape::Mesh(mesh)
        }
    };
    let color = color.map(|channel| f32::from(channel) / 255.0);
    Some((Arc::new(Surface { shape, color }), solid))
}

/// Removes fluid that begins inside of bodies or reaches into them: it makes room, which needs no note.
pub fn remove_inside(
    path: &str,
    grains: &mut Grains,
    bodies: &[RigidBody],
    radius: f64,
    dimensions: Dimensions,
    report: &mut Report,
) {
    for same in bodies.chunk_by(|a, b| a.index == b.index) {
        let Some(surface) = &same[0].surface else { continue };
        let obstacle = Obstacle::new(&surface.shape, dimensions);
        let farthest = half_size(&surface.shape).length() + radius;
        let is_free = |at: &DVec3| {
            same.iter().all(|body| {
                let away = *at - body.center;
                away.length() > farthest
                    || !obstacle.touches(body.orientation.inverse() * away, fit::reach(radius))
            })
        };
        let kept: Vec<bool> = grains.position.iter().map(is_free).collect();
        if !kept.is_empty() && !kept.contains(&true) {
            report.problem(
                path,
                format!(
                    "begins inside of bodies[{}], which leaves none of it",
                    same[0].index
                ),
                "move one of them, or remove one",
            );
        }
        grains.keep(&kept);
    }
}

/// A problem for what such bodies do not know.
pub fn check(file: &SceneFile, report: &mut Report) {
    let Some(fluid) = &file.fluid else { return };
    let rigid = file.bodies.iter().enumerate();
    let rigid = rigid.filter(|(_, body)| body.rigid.is_some());
    for (i, body) in rigid {
        let path = format!("bodies[{i}]");
        if fluid.solver != FluidSolver::Dfsph {
            report.problem(
                format!("{path}.rigid"),
                "rigid bodies float in fluids of the solver `dfsph` only",
                "set fluid.solver to `dfsph`, or leave `rigid` out",
            );
        }
        let of_fluids = [
            ("spacing", body.spacing.is_some()),
            ("material", body.material.is_some()),
            ("flow", body.flow.is_some()),
            ("pressure", body.pressure != StartPressure::Rest),
        ];
        for (key, _) in of_fluids.into_iter().filter(|(_, given)| *given) {
            report.problem(
                format!("{path}.{key}"),
                "has no effect on a rigid body, which is no fluid",
                "leave it out",
            );
        }
    }
}

/// Gives each body its particles, `depth` metres deep, and says where bodies do not fit.
pub fn cover(
    rigid: &mut [RigidBody],
    file: &SceneFile,
    frame: &Frame,
    colliders: &[Collider],
    depth: f64,
    report: &mut Report,
) {
    let spacing = 2.0 * file.radius();
    let mut placed = Placed::new(NEAREST * spacing / 2.0);
    let mut first = 0;
    for same in rigid.chunk_by_mut(|a, b| a.index == b.index) {
        let index = same[0].index;
        let path = format!("bodies[{index}]");
        let Some(surface) = same[0].surface.clone() else {
            continue;
        };
        let most = most_points(&surface.shape, frame.dimensions, spacing) * same.len() as f64;
        let help = "make it smaller, or fluid.spacing larger";
        if !report.room_for(&path, "takes up to", most, "boundary particles", help) {
            return;
        }
        let places = points(&surface.shape, frame.dimensions, spacing, depth);
        if places.len() < 2 {
            report.problem(
                &path,
                "is a rigid body too small for two particles",
                "make its shape larger or fluid.spacing smaller, or leave `rigid` out",
            );
            return;
        }
        for body in same {
            body.first = first;
            body.places.clone_from(&places);
            first += places.len() as u32;
            if !fits(&path, body, spacing / 2.0, &mut placed, frame, colliders, report) {
                return;
            }
        }
    }
}

fn fits(
    path: &str,
    body: &RigidBody,
    radius: f64,
    placed: &mut Placed,
    frame: &Frame,
    colliders: &[Collider],
    report: &mut Report,
) -> bool {
    let sound = report.problems.len();
    let mut particles = body.particles();
    let all = particles.position.len();
    fit::check_walls(path, &particles, radius, frame, report);
    fit::remove_inside_colliders(path, &mut particles, colliders, radius, frame.dimensions, report);
    fit::remove_overlaps(path, &mut particles, placed, report);
    let lost = all - particles.position.len();
    if lost > 0 {
        report.problem(
            path,
            format!("a rigid body would lose {lost} of its {all} particles to others"),
            "move it, or make it smaller",
        );
    }
    placed.add(&particles, body.index);
    report.problems.len() == sound
}

/// Boundary particles of bodies, then those of walls and obstacles.
pub fn before(walls: BoundaryParticles, rigid: &[RigidBody], colliders: usize) -> BoundaryParticles {
    let mut all = BoundaryParticles {
        depth: walls.depth,
        side_velocity: walls.side_velocity,
        ..BoundaryParticles::default()
    };
    for (number, body) in rigid.iter().enumerate() {
        let particles = body.particles();
        all.body
            .extend(particles.position.iter().map(|_| (colliders + number) as u32));
        all.position
            .extend(particles.position.iter().map(|p| p.as_vec3()));
        all.surface_velocity
            .extend(particles.velocity.iter().map(|v| v.as_vec3()));
    }
    all.position.extend(walls.position);
    all.surface_velocity.extend(walls.surface_velocity);
    all.body.extend(walls.body);
    all
}

/// Particles of a shape in its own axes.
fn points(shape: &ColliderShape, dimensions: Dimensions, spacing: f64, depth: f64) -> Vec<DVec3> {
    match shape {
        ColliderShape::Box { min, max } => {
            boundary::box_shell(min.as_dvec3(), max.as_dvec3(), dimensions, spacing, depth)
        }
        ColliderShape::Sphere { center, radius, .. } => {
            let (center, radius) = (center.as_dvec3(), f64::from(*radius));
            boundary::sphere_shells(center, radius, false, dimensions, spacing, depth)
        }
        _ => lattice_shell(shape, dimensions, spacing, depth),
    }
}

/// Points of a lattice around the center of mass that lie inside, no deeper than `depth`.
fn lattice_shell(shape: &ColliderShape, dimensions: Dimensions, spacing: f64, depth: f64) -> Vec<DVec3> {
    let obstacle = Obstacle::new(shape, dimensions);
    let ticks = (half_size(shape) / spacing).ceil().as_ivec3();
    let place = |k: i32| (f64::from(k) + 0.5) * spacing;
    let mut points = Vec::new();
    for y in -ticks.y..ticks.y {
        for z in -ticks.z..ticks.z {
            for x in -ticks.x..ticks.x {
                let point = DVec3::new(place(x), place(y), place(z));
                if obstacle.touches(point, 0.0) && !obstacle.is_deeper(point, depth) {
                    points.push(point);
                }
            }
        }
    }
    points
}

/// Half of the sides of a box around the center of mass that holds the shape, metres.
fn half_size(shape: &ColliderShape) -> DVec3 {
    let corners = |low: Vec3, high: Vec3| low.abs().max(high.abs()).as_dvec3();
    match shape {
        ColliderShape::Box { min, max } => corners(*min, *max),
        ColliderShape::Sphere { center, radius, .. } => corners(center - *radius, center + *radius),
        ColliderShape::Cylinder { from, to, radius, .. } => {
            corners(from.min(*to) - *radius, from.max(*to) + *radius)
        }
        ColliderShape::Mesh(mesh) => {
            let (low, high) = mesh.bounds();
            low.abs().max(high.abs())
        }
        ColliderShape::Plane { .. } => DVec3::ZERO,
    }
}

/// Points of a lattice in the box around a shape.
fn most_points(shape: &ColliderShape, dimensions: Dimensions, spacing: f64) -> f64 {
    let along = 2.0 * half_size(shape) / spacing + 1.0;
    (0..dimensions.count()).map(|axis| along[axis]).product()
}
