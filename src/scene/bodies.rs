//! Bodies, filled with grains.

use std::f64::consts::PI;
use std::path::Path;

use glam::DVec3;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use super::filling::Filling;
use super::fit::{self, Grains, Placed};
use super::floating;
use super::frame::{Frame, LARGEST_COORDINATE, Report};
use super::grain_materials;
use super::mesh::Mesh;
use super::model::{self, Arrangement, Body, SceneFile, Shape};
use super::obstacles::{self, FILE_HELP, check_corners, transform};
use super::rigid::{self, RigidBody};
use super::shapes::{self, Region};
use super::sizes::{self, Draw, PACKED};
use super::text::number;
use super::{Collider, Dimensions, Particles, particle_file};
use super::{fluid, fluid_start};

/// Share of a shape that a random arrangement of equal grains fills when the scene does not say.
const SCATTERED: f64 = 0.25;

/// The particles that are there from the start, in the order of the bodies.
pub struct Filled {
    pub particles: Particles,
    /// Those of them that are parts of rigid bodies are these bodies'.
    pub rigid: Vec<RigidBody>,
    /// Which of them belong to each body.
    pub bodies: Vec<std::ops::Range<usize>>,
}

/// Fills every body; `fillings` say how, for boxes of fluid.
pub fn fill(
    file: &SceneFile,
    fillings: &[Option<Filling>],
    frame: &Frame,
    colliders: &[Collider],
    folder: &Path,
    report: &mut Report,
) -> Filled {
    // How near particles of a body may come to others: in a compressed lattice, nearer than a spacing.
    let reach = |filling: &Option<Filling>| {
        file.radius() * filling.map_or(1.0, |filling| filling.stretch.min_element().min(1.0))
    };
    let nearest = fillings.iter().map(reach).fold(file.radius(), f64::min);
    let mut placed = Placed::new(nearest);
    let mut bodies = Vec::new();
    let mut particles = Particles::default();
    let mut rigid = Vec::new();
    if file.fluid.is_some() {
        // Fluid makes room for them, wherever they stand in the file; their particles come later.
        for (i, body) in file.bodies.iter().enumerate() {
            if let Some(given) = &body.rigid {
                rigid.extend(rigid::bodies(i, body, given, file, frame, folder, report));
            }
        }
    }
    for (i, body) in file.bodies.iter().enumerate() {
        let path = format!("bodies[{i}]");
        let first = particles.len();
        bodies.push(first..first);
        if file.fluid.is_some() && body.rigid.is_some() {
            continue;
        }
        if let Some(given) = &body.rigid {
            for mut one in rigid::bodies(i, body, given, file, frame, folder, report) {
                one.first = particles.len() as u32;
                let grains = one.particles();
                let all = grains.position.len();
                let Some(grains) = fitted(&path, grains, file.radius(), &placed, frame, colliders, report)
                else {
                    break;
                };
                if grains.position.len() < all {
                    let lost = all - grains.position.len();
                    report.problem(
                        &path,
                        format!("a rigid body would lose {lost} of its {all} particles to others"),
                        "move it, or make it smaller",
                    );
                    break;
                }
                placed.add(&grains, i);
                rigid.push(one);
                add_material(&path, body, grains.position.len(), file, &mut particles, report);
                add(&mut particles, &grains, |_| DVec3::ZERO);
            }
            bodies[i] = first..particles.len();
            continue;
        }
        let Some(grains) = grains(i, body, fillings[i], file, frame, folder, report) else {
            continue;
        };
        if grains.position.is_empty() {
            let help = format!("make its shape larger or {} smaller", file.size());
            report.problem(&path, "is empty: not one particle fits", help);
            continue;
        }
        let Some(mut grains) = fitted(
            &path,
            grains,
            reach(&fillings[i]),
            &placed,
            frame,
            colliders,
            report,
        ) else {
            continue;
        };
        if file.fluid.is_some() {
            let radius = reach(&fillings[i]);
            floating::remove_inside(&path, &mut grains, &rigid, radius, frame.dimensions, report);
        }
        if i + 1 < file.bodies.len() {
            placed.add(&grains, i);
        }
        add_material(&path, body, grains.position.len(), file, &mut particles, report);
        if let Some(fluid) = &file.fluid {
            fill_fluid(
                &path,
                body,
                fluid,
                &grains.position,
                file,
                frame,
                &mut particles,
                report,
            );
        }
        let flow = |p: &DVec3| match &body.flow {
            Some(flow) => fluid_start::flow_at(flow, frame.dimensions, *p + frame.origin).0,
            None => DVec3::ZERO,
        };
        add(&mut particles, &grains, flow);
        bodies[i] = first..particles.len();
    }
    if rigid.len() > rigid::MOST_BODIES {
        report.problem(
            "bodies",
            format!("{} rigid bodies", rigid.len()),
            format!("stay at or below {}", rigid::MOST_BODIES),
        );
    }
    if file.grains.is_some() {
        rigid::mark(
            &rigid,
            file.density(),
            file.radius(),
            frame.dimensions,
            &mut particles,
        );
    }
    Filled {
        particles,
        rigid,
        bodies,
    }
}

/// Adds grains, whose velocity is their own and what `flow` says at their place.
fn add(particles: &mut Particles, grains: &Grains, flow: impl Fn(&DVec3) -> DVec3) {
    let position = grains.position.iter().map(|p| p.as_vec3());
    particles.position.extend(position);
    let velocity = grains.velocity.iter().zip(&grains.position);
    let velocity = velocity.map(|(v, p)| (*v + flow(p)).as_vec3());
    particles.velocity.extend(velocity);
    particles
        .radius
        .extend(grains.radius.iter().map(|&radius| radius as f32));
}

/// The grains of a body that find room; `None` where one lies too far away. `reach` is how near they come to others, metres.
fn fitted(
    path: &str,
    mut grains: Grains,
    reach: f64,
    placed: &Placed,
    frame: &Frame,
    colliders: &[Collider],
    report: &mut Report,
) -> Option<Grains> {
    let farthest = grains
        .position
        .iter()
        .map(|p| p.abs().max_element())
        .fold(0.0, f64::max);
    if farthest > LARGEST_COORDINATE {
        report.problem(
            path,
            format!("a particle lies {} m from the domain's center", number(farthest)),
            format!("give coordinates below {} m", number(LARGEST_COORDINATE)),
        );
        return None;
    }
    fit::check_walls(path, &grains, reach, frame, report);
    fit::remove_inside_colliders(path, &mut grains, colliders, reach, frame.dimensions, report);
    fit::remove_overlaps(path, &mut grains, placed, report);
    Some(grains)
}

/// Of `count` grains of a body, where grains differ in it.
fn add_material(
    path: &str,
    body: &Body,
    count: usize,
    file: &SceneFile,
    particles: &mut Particles,
    report: &mut Report,
) {
    if grain_materials::are_mixed(file) {
        let name = body.material.as_deref();
        let material = grain_materials::number(&format!("{path}.material"), name, file, report);
        particles.material.extend(std::iter::repeat_n(material, count));
    }
}

/// What a fluid's particles have besides: their pressure at the start and their material.
#[allow(clippy::too_many_arguments)]
fn fill_fluid(
    path: &str,
    body: &Body,
    fluid: &model::Fluid,
    positions: &[DVec3],
    file: &SceneFile,
    frame: &Frame,
    particles: &mut Particles,
    report: &mut Report,
) {
    let material = fluid::material(
        &format!("{path}.material"),
        body.material.as_deref(),
        file,
        report,
    );
    let density = fluid
        .materials
        .get(material as usize)
        .map_or(fluid.density, |m| m.density);
    let gravity = DVec3::new(
        file.gravity.0[0],
        file.gravity.0[1],
        file.gravity.0.get(2).copied().unwrap_or(0.0),
    );
    let pressures = fluid_start::start_pressures(body, fluid, positions, density, gravity, frame);
    particles
        .start_pressure
        .extend(pressures.iter().map(|&p| p as f32));
    if !fluid.materials.is_empty() {
        particles.material.extend(positions.iter().map(|_| material));
    }
}

fn grains(
    index: usize,
    body: &Body,
    filling: Option<Filling>,
    file: &SceneFile,
    frame: &Frame,
    folder: &Path,
    report: &mut Report,
) -> Option<Grains> {
    let path = format!("bodies[{index}]");
    let sound = report.problems.len();
    let velocity = report.optional(
        &format!("{path}.velocity"),
        body.velocity.as_ref(),
        frame.dimensions,
    );
    let shape = format!("{path}.shape");
    let radius = file.radius();
    // Each body has its own stream, so that changing one body leaves the others as they were.
    let mut random = ChaCha8Rng::seed_from_u64(file.seed);
    random.set_stream(index as u64);
    let scene = file;
    if let Shape::Particles { file, placement } = &body.shape {
        if body.spacing.is_some() || body.jitter != 0.0 || body.arrangement == Some(Arrangement::Random) {
            report.problem(
                &path,
                "a particle file already says where particles are",
                "remove `arrangement`, `spacing` and `jitter`",
            );
        }
        let mut grains = from_file(&shape, file, placement, velocity, frame, folder, report)?;
        sizes::fit(&shape, &mut grains.radius, scene, placement, report);
        fit::remove_coincident(&path, &mut grains, scene.smallest_radius(), report);
        return Some(grains);
    }
    if let Shape::Ring { center, inner, outer } = &body.shape {
        let center = report.vector(&format!("{shape}.center"), center, frame.dimensions);
        let spacing = body.spacing.unwrap_or(2.0 * radius);
        let rings = ((outer - inner) / spacing).round();
        if frame.dimensions == Dimensions::Three || rings < 1.0 {
            report.problem(
                &shape,
                "a ring is for 2D scenes and at least one spacing wide",
                "make `outer` larger, or use another shape",
            );
            return None;
        }
        if report.problems.len() > sound {
            return None;
        }
        let width = (outer - inner) / rings;
        let count = PI * (outer + inner) * (outer - inner) / (width * width) + rings;
        if !report.room_for(&path, "would hold about", count, "particles", &smaller(file)) {
            return None;
        }
        let position = shapes::rings(frame.local(center), inner + 0.5 * width, rings as u32, width);
        let velocity = vec![velocity; position.len()];
        let radius = Vec::new();
        return Some(Grains {
            position,
            velocity,
            radius,
            tolerance: fit::TOLERANCE,
        });
    }
    let region = region(&shape, &body.shape, frame, folder, report)?;
    if report.problems.len() > sound {
        // Where its numbers are wrong, so would be what is made of them.
        return None;
    }
    if let Some(draw) = Draw::new(file, frame.dimensions) {
        let fraction = body.fraction.unwrap_or(PACKED);
        let all = fraction * region.content(frame.dimensions);
        let count = all / (draw.mean_share() * sizes::content(radius, frame.dimensions));
        if !report.room_for(&path, "would hold about", count, "particles", &smaller(file)) {
            return None;
        }
        let balls = shapes::pack(&region, frame.dimensions, &draw, radius, fraction, &mut random);
        return Some(Grains {
            velocity: vec![velocity; balls.len()],
            radius: balls.iter().map(|ball| ball.1).collect(),
            position: balls.into_iter().map(|ball| ball.0).collect(),
            tolerance: fit::TOLERANCE,
        });
    }
    let arrangement = body.arrangement.unwrap_or_default();
    let spacing = body.spacing.unwrap_or(2.0 * radius);
    if spacing < 2.0 * radius * (1.0 - 1e-9) {
        report.problem(
            format!("{path}.spacing"),
            format!(
                "{} m is less than twice a particle's radius: particles would overlap",
                number(spacing)
            ),
            format!("give at least {} m, or leave it out", number(2.0 * radius)),
        );
        return None;
    }
    let between = match arrangement {
        Arrangement::Lattice => spacing,
        Arrangement::Random => 2.0 * radius,
    };
    let count = expected_points(
        &region,
        frame.dimensions,
        between,
        report.allowance.particles as f64,
    );
    if !report.room_for(&path, "would hold about", count, "particles", &smaller(file)) {
        return None;
    }
    let position = match arrangement {
        Arrangement::Lattice => {
            let mut points = |region| {
                shapes::lattice(
                    region,
                    frame.dimensions,
                    radius,
                    spacing,
                    body.jitter,
                    &mut random,
                )
            };
            match (&region, filling) {
                (Region::Box { min, .. }, Some(filling)) => {
                    let (min, max) = (*min, *min + filling.counts * spacing);
                    let points = points(&Region::Box { min, max });
                    points
                        .iter()
                        .map(|p| min + (*p - min) * filling.stretch)
                        .collect()
                }
                _ => points(&region),
            }
        }
        Arrangement::Random => {
            let fraction = body.fraction.unwrap_or(SCATTERED);
            shapes::random(&region, frame.dimensions, radius, fraction, &mut random)
        }
    };
    let velocity = vec![velocity; position.len()];
    Some(Grains {
        position,
        velocity,
        radius: Vec::new(),
        tolerance: fit::TOLERANCE,
    })
}

pub(super) fn smaller(file: &SceneFile) -> String {
    format!("make it smaller or {} larger", file.size())
}

/// Local coordinates.
pub(super) fn region(
    path: &str,
    shape: &Shape,
    frame: &Frame,
    folder: &Path,
    report: &mut Report,
) -> Option<Region> {
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
                report.problem(
                    path,
                    "a cylinder in a 2D scene",
                    "use a box or sphere, or set `dimensions` to 3",
                );
                return None;
            }
            let (from, to) = (point("from", from), point("to", to));
            if from == to {
                report.problem(
                    path,
                    "`from` and `to` are one point",
                    "move them apart, along the cylinder's axis",
                );
                return None;
            }
            let radius = *radius;
            Some(Region::Cylinder { from, to, radius })
        }
        Shape::Mesh { file, placement } => {
            obstacles::mesh(path, file, placement, frame, folder, report).map(Region::Mesh)
        }
        Shape::Particles { .. } | Shape::Ring { .. } => None,
    }
}

/// Points of a lattice in the region, about, before any is made; where there are more than `most` in its bounds, those.
pub(super) fn expected_points(region: &Region, dimensions: Dimensions, spacing: f64, most: f64) -> f64 {
    let tried = lattice_points(region, dimensions, spacing);
    let content = region.content(dimensions) / spacing.powi(dimensions.count() as i32);
    // Of a thin shape, most points of the lattice around it lie outside; going through them takes time all the same.
    if tried > most {
        tried
    } else {
        content.max(tried / 16.0).min(tried)
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
    (0..dimensions.count())
        .map(|axis| (size[axis] / spacing).max(1.0))
        .product()
}

/// The particles of a file, by id.
pub(super) fn from_file(
    path: &str,
    file: &str,
    placement: &model::Placement,
    velocity: DVec3,
    frame: &Frame,
    folder: &Path,
    report: &mut Report,
) -> Option<Grains> {
    let file = report.file(&format!("{path}.file"), folder, file)?;
    let loaded = match particle_file::load(&file, frame.dimensions) {
        Ok(loaded) => loaded,
        Err(reason) => {
            report.problem(format!("{path}.file"), reason, FILE_HELP);
            return None;
        }
    };
    let (sound, count) = (report.problems.len(), loaded.position.len() as f64);
    let (scale, rotate, translate) = transform(path, placement, frame, report);
    if report.problems.len() > sound
        || !report.room_for(path, "holds", count, "particles", "leave some of them out")
    {
        return None;
    }
    let turned = |points: Vec<DVec3>, scale: DVec3, translate: DVec3| {
        let cloud = Mesh {
            vertices: points,
            triangles: Vec::new(),
        };
        cloud.placed(scale, rotate, translate).vertices
    };
    let position = turned(loaded.position, scale, translate);
    let own = loaded
        .velocity
        .unwrap_or_else(|| vec![DVec3::ZERO; position.len()]);
    let own = turned(own, DVec3::ONE, DVec3::ZERO);
    let mut order: Vec<usize> = (0..position.len()).collect();
    if let Some(ids) = &loaded.id {
        order.sort_by_key(|&i| ids[i]);
    }
    let radius = loaded.radius.unwrap_or_default();
    Some(Grains {
        position: order.iter().map(|&i| frame.snap(position[i])).collect(),
        velocity: order.iter().map(|&i| own[i] + velocity).collect(),
        radius: order
            .iter()
            .filter_map(|&i| Some(radius.get(i)? * scale.x))
            .collect(),
        tolerance: fit::PRESSED,
    })
}
