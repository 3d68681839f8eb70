//! Rigid bodies: which places the grains that they are made of take, and what the solid shape weighs.

pub(super) mod solid;

use std::collections::HashSet;
use std::f64::consts::{PI, TAU};
use std::path::Path;
use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3, IVec3};
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use super::bodies::{self, expected_points, smaller};
use super::fit::{Grains, TOLERANCE};
use super::floating::{self, Surface};
use super::frame::{Frame, Report};
use super::friction::Friction;
use super::model::{Arrangement, Body, ContactLaw, Copies, Rigid, SceneFile, Shape, Wall};
use super::shapes::{self, Region};
use super::text::number;
use super::{Dimensions, Particles};
use solid::Solid;

/// More bodies would fill tables and memory that every frame brings to the host.
pub const MOST_BODIES: usize = 1 << 16;

/// A body whose particles keep their places in it.
#[derive(Debug, Clone)]
pub struct RigidBody {
    /// Index of its shape among the bodies of the scene file.
    pub index: usize,
    /// Id of its first particle; the others follow. In a fluid, its place among the boundary particles.
    pub first: u32,
    /// Where its particles are, from its center of mass along its own axes, metres.
    pub places: Vec<DVec3>,
    /// Kilograms.
    pub mass: f64,
    /// About its center of mass along its own axes, kg·m². In 2D only turning about z counts.
    pub inertia: DMat3,
    /// Its center of mass at the start, local, metres.
    pub center: DVec3,
    /// From its own axes, which are those of the shape as it is written, to the scene's, at the start.
    pub orientation: DQuat,
    /// m/s.
    pub velocity: DVec3,
    /// rad/s.
    pub angular_velocity: DVec3,
    /// Of a body in a fluid.
    pub surface: Option<Arc<Surface>>,
}

impl RigidBody {
    /// Its particles at the start.
    pub fn particles(&self) -> Grains {
        let arms = self.places.iter().map(|place| self.orientation * *place);
        Grains {
            radius: Vec::new(),
            tolerance: TOLERANCE,
            position: arms.clone().map(|arm| self.center + arm).collect(),
            velocity: arms
                .map(|arm| self.velocity + self.angular_velocity.cross(arm))
                .collect(),
        }
    }

    /// A speed that few of its particles exceed at the start, m/s.
    pub fn speed(&self) -> f64 {
        let axes = self.inertia;
        let gyration = (axes.x_axis.x + axes.y_axis.y + axes.z_axis.z) / self.mass;
        self.velocity.length() + self.angular_velocity.length() * gyration.sqrt()
    }

    /// 1/(kg·m²), along its own axes; in 2D only about z.
    pub fn inverse_inertia(&self, dimensions: Dimensions) -> DMat3 {
        match dimensions {
            Dimensions::Two => DMat3::from_diagonal(DVec3::Z / self.inertia.z_axis.z),
            Dimensions::Three => self.inertia.inverse(),
        }
    }

    /// Particles that may touch a flat wall at once, at most: those of the fullest layer along one of its axes.
    fn largest_face(&self, dimensions: Dimensions, radius: f64) -> usize {
        let of_axis = |axis: usize| {
            let mut along: Vec<f64> = self.places.iter().map(|place| place[axis]).collect();
            along.sort_by(f64::total_cmp);
            let layer = |first: usize| along.partition_point(|&at| at < along[first] + 0.2 * radius) - first;
            (0..along.len()).map(layer).max().unwrap_or(1)
        };
        (0..dimensions.count()).map(of_axis).max().unwrap_or(1)
    }
}

/// How much faster than grains' contacts those of bodies are: factors on the duration of the shortest and on the rate of the
/// strongest damping. Several particles of a body may touch at once, and it turns away where one of them does.
pub fn hardness(bodies: &[RigidBody], dimensions: Dimensions, radius: f64, grain_mass: f64) -> (f64, f64) {
    let (mut duration, mut damping) = (1.0f64, 1.0f64);
    for body in bodies {
        let face = body.largest_face(dimensions, radius) as f64;
        let grains = body.mass / grain_mass;
        let inverse = body.inverse_inertia(dimensions);
        let turned = |place: &DVec3| {
            body.mass
                * place.length_squared()
                * inverse
                    .to_cols_array()
                    .iter()
                    .fold(0.0, |most: f64, &x| most.max(x))
        };
        let corner = 1.0 + body.places.iter().map(turned).fold(0.0, f64::max);
        let pushed = face.max(corner) / grains;
        duration = duration.min(1.0 / pushed.sqrt());
        // Dashpots are as strong as the whole body at one point asks for.
        damping = damping.max(face.max(corner) / grains.sqrt());
    }
    (duration, damping)
}

/// Contacts as `friction` has them, with bodies among the grains.
pub fn hardened(friction: &Friction, (duration, damping): (f64, f64)) -> Friction {
    Friction {
        duration: friction.duration * duration,
        damping_rate: friction.damping_rate * damping,
        ..friction.clone()
    }
}

/// Says of particles which bodies they are parts of, where there are bodies.
pub fn mark(
    bodies: &[RigidBody],
    density: f64,
    radius: f64,
    dimensions: Dimensions,
    particles: &mut Particles,
) {
    if bodies.is_empty() {
        return;
    }
    particles.body = vec![0; particles.len()];
    particles.body_mass = vec![0.0; particles.len()];
    let grain = density * solid::ball_content(radius, dimensions);
    for (number, body) in (1..).zip(bodies) {
        let own = body.first as usize..body.first as usize + body.places.len();
        particles.body[own.clone()].fill(number);
        particles.body_mass[own].fill((body.mass / grain) as f32);
    }
}

/// A problem for what rigid bodies do not know.
pub fn check(file: &SceneFile, frame: &Frame, report: &mut Report) {
    let Some(first) = file.bodies.iter().position(|body| body.rigid.is_some()) else {
        return;
    };
    let path = format!("bodies[{first}].rigid");
    match &file.grains {
        None => floating::check(file, report),
        Some(grains) if grains.law == ContactLaw::SpringDashpot => report.problem(
            &path,
            "grains that do not rub would let rigid bodies slide and never rest",
            "set grains.law to `linear` or `hertz`, or leave `rigid` out",
        ),
        Some(_) => {}
    }
    let colored = |body: &Body| body.rigid.as_ref().is_some_and(|rigid| rigid.color.is_some());
    if file.grains.is_some()
        && let Some(i) = file.bodies.iter().position(colored)
    {
        report.problem(
            format!("bodies[{i}].rigid.color"),
            "has no effect on grains, which are drawn one by one",
            "leave it out, or color by `body`: render.color.by",
        );
    }
    let axes = frame.dimensions.count();
    if frame.sides[..axes]
        .iter()
        .flatten()
        .any(|&side| side == Wall::Periodic)
    {
        report.problem(
            &path,
            "a rigid body that crosses a periodic side would be in two places",
            "choose other sides, or leave `rigid` out",
        );
    }
    if file.time.adaptive {
        report.problem(
            "time.adaptive",
            "adaptive steps do not know how fast rigid bodies turn",
            "leave it out",
        );
    }
    for (i, body) in file
        .bodies
        .iter()
        .enumerate()
        .filter(|(_, body)| body.rigid.is_some())
    {
        if body.arrangement == Some(Arrangement::Random) || body.jitter != 0.0 {
            report.problem(
                format!("bodies[{i}]"),
                "the particles of a rigid body stand in order",
                "leave `arrangement` and `jitter` out",
            );
        }
    }
}

/// The bodies that `bodies[index]` of the file asks for, without their ids; a problem, and none, where something is wrong.
pub fn bodies(
    index: usize,
    body: &Body,
    rigid: &Rigid,
    file: &SceneFile,
    frame: &Frame,
    folder: &Path,
    report: &mut Report,
) -> Vec<RigidBody> {
    let path = format!("bodies[{index}]");
    let sound = report.problems.len();
    let velocity = report.optional(
        &format!("{path}.velocity"),
        body.velocity.as_ref(),
        frame.dimensions,
    );
    let angular_velocity = angular_velocity(&path, rigid, frame.dimensions, report);
    let offsets = offsets(&path, rigid.copies.as_ref(), frame.dimensions, report);
    let made = match file.fluid {
        Some(_) => floating::surface(&path, body, rigid, frame, folder, report)
            .map(|(surface, solid)| (Vec::new(), solid, Some(surface))),
        None => points(&path, body, offsets.len(), file, frame, folder, report)
            .map(|(points, solid)| (points, solid, None)),
    };
    let Some((points, solid, surface)) = made else {
        return Vec::new();
    };
    if report.problems.len() > sound {
        return Vec::new();
    }
    if points.len() < 2 && surface.is_none() {
        report.problem(
            &path,
            match points.len() {
                0 => "is empty: not one particle fits",
                _ => "is a rigid body of one particle, which is a grain",
            },
            format!(
                "make its shape larger or {} smaller, or leave `rigid` out",
                file.size()
            ),
        );
        return Vec::new();
    }
    let density = rigid.density.unwrap_or(file.density());
    let places: Vec<DVec3> = points.iter().map(|point| point - solid.center).collect();
    let random_rotation = rigid.copies.as_ref().is_some_and(|copies| copies.random_rotation);
    // As for grains in disorder, each body of the file has a stream of its own.
    let mut random = ChaCha8Rng::seed_from_u64(file.seed);
    random.set_stream(index as u64);
    let copy = |offset: &DVec3| RigidBody {
        index,
        first: 0,
        places: places.clone(),
        mass: density * solid.content,
        inertia: density * solid.inertia,
        center: solid.center + *offset,
        orientation: match random_rotation {
            true => any_rotation(frame.dimensions, &mut random),
            false => DQuat::IDENTITY,
        },
        velocity,
        angular_velocity,
        surface: surface.clone(),
    };
    offsets.iter().map(copy).collect()
}

fn angular_velocity(path: &str, rigid: &Rigid, dimensions: Dimensions, report: &mut Report) -> DVec3 {
    match (rigid.angular_velocity.as_deref(), dimensions) {
        (None, _) => DVec3::ZERO,
        (Some(&[z]), Dimensions::Two) => DVec3::Z * z,
        (Some(&[x, y, z]), Dimensions::Three) => DVec3::new(x, y, z),
        (Some(given), _) => {
            report.problem(
                format!("{path}.rigid.angular_velocity"),
                format!("{} numbers in a {}D scene", given.len(), dimensions.count()),
                match dimensions {
                    Dimensions::Two => "give one number, in rad/s, counter-clockwise",
                    Dimensions::Three => "give three numbers, about x, y and z, in rad/s",
                },
            );
            DVec3::ZERO
        }
    }
}

/// How far each copy stands from the shape, metres: y slowest, x fastest.
fn offsets(path: &str, copies: Option<&Copies>, dimensions: Dimensions, report: &mut Report) -> Vec<DVec3> {
    let Some(copies) = copies else {
        return vec![DVec3::ZERO];
    };
    let path = format!("{path}.rigid.copies");
    let step = report.vector(&format!("{path}.step"), &copies.step, dimensions);
    let axes = dimensions.count();
    let number_of = |axis: usize| u64::from(copies.counts.get(axis).copied().unwrap_or(1));
    if copies.counts.len() != axes || copies.counts.contains(&0) {
        report.problem(
            format!("{path}.counts"),
            format!("{:?} in a {axes}D scene", copies.counts),
            format!("give {axes} numbers of at least 1"),
        );
        return Vec::new();
    }
    let all = (0..3).map(number_of).try_fold(1u64, u64::checked_mul);
    if all.is_none_or(|all| all > MOST_BODIES as u64) {
        report.problem(
            format!("{path}.counts"),
            "are too many rigid bodies",
            format!("stay at or below {MOST_BODIES} in all"),
        );
        return Vec::new();
    }
    let mut offsets = Vec::new();
    for y in 0..number_of(1) {
        for z in 0..number_of(2) {
            for x in 0..number_of(0) {
                offsets.push(DVec3::new(x as f64, y as f64, z as f64) * step);
            }
        }
    }
    offsets
}

/// Every orientation alike (Shoemake 1992).
fn any_rotation(dimensions: Dimensions, random: &mut ChaCha8Rng) -> DQuat {
    if dimensions == Dimensions::Two {
        return DQuat::from_rotation_z(TAU * random.random::<f64>());
    }
    let [share, first, second]: [f64; 3] = [random.random(), random.random(), random.random()];
    let (a, b) = ((1.0 - share).sqrt(), share.sqrt());
    let ((sin_a, cos_a), (sin_b, cos_b)) = ((TAU * first).sin_cos(), (TAU * second).sin_cos());
    DQuat::from_xyzw(a * sin_a, a * cos_a, b * sin_b, b * cos_b)
}

/// Local places of the particles of one body, and the solid that they stand for.
fn points(
    path: &str,
    body: &Body,
    copies: usize,
    file: &SceneFile,
    frame: &Frame,
    folder: &Path,
    report: &mut Report,
) -> Option<(Vec<DVec3>, Solid)> {
    let (radius, dimensions) = (file.radius(), frame.dimensions);
    let shape = format!("{path}.shape");
    if let Shape::Particles {
        file: name,
        placement,
    } = &body.shape
    {
        if body.spacing.is_some() {
            report.problem(
                path,
                "a particle file already says where particles are",
                "remove `spacing`",
            );
        }
        let grains = bodies::from_file(&shape, name, placement, DVec3::ZERO, frame, folder, report)?;
        let solid = Solid::of_balls(&grains.position, radius, dimensions);
        return room(path, grains.position.len() as f64, copies, file, report)
            .then_some((grains.position, solid));
    }
    let spacing = body.spacing.unwrap_or(2.0 * radius);
    let bounds = [radius * (1.0 - 1e-9), 2.0 * radius * (1.0 + 1e-9)];
    let beyond = match spacing {
        _ if spacing < bounds[0] => Some("is less than a particle's radius"),
        _ if spacing > bounds[1] => Some("would leave gaps between particles that others get through"),
        _ => None,
    };
    if let Some(beyond) = beyond {
        report.problem(
            format!("{path}.spacing"),
            format!("{} m {beyond}", number(spacing)),
            format!(
                "give {} to {} m, or leave it out",
                number(radius),
                number(2.0 * radius)
            ),
        );
        return None;
    }
    if let Shape::Ring { center, inner, outer } = &body.shape {
        let center = frame.local(report.vector(&format!("{shape}.center"), center, dimensions));
        if dimensions == Dimensions::Three || outer - inner < 2.0 * radius * (1.0 - 1e-9) {
            report.problem(
                &shape,
                "a ring is for 2D scenes and at least one particle wide",
                "make `outer` larger, or use another shape",
            );
            return None;
        }
        // Whole circles from the outer one on, as far as they fit.
        let rings = ((outer - inner - 2.0 * radius) / spacing + 1e-9).floor() + 1.0;
        let count = TAU * outer / spacing * rings;
        return room(path, count, copies, file, report).then(|| {
            let circles = (0..rings as u32)
                .flat_map(|ring| circle(center, outer - radius - f64::from(ring) * spacing, spacing));
            (circles.collect(), Solid::ring(center, *inner, *outer))
        });
    }
    let region = bodies::region(&shape, &body.shape, frame, folder, report)?;
    let solid = Solid::of_region(&region, dimensions)?;
    let covered = |radius: f64| match dimensions {
        Dimensions::Two => TAU * radius / spacing,
        Dimensions::Three => 4.0 * PI * radius * radius / (spacing * spacing * HEXAGON),
    };
    let count = match &region {
        Region::Box { min, max } => (0..dimensions.count())
            .map(|axis| layers(max[axis] - min[axis], radius, spacing))
            .product(),
        Region::Sphere { radius: outer, .. } => covered((outer - radius).max(0.0)).max(1.0),
        _ => expected_points(&region, dimensions, spacing, report.allowance.particles as f64),
    };
    if !room(path, count, copies, file, report) {
        return None;
    }
    let points = match &region {
        Region::Box { min, max } => brick(*min, *max, radius, spacing, dimensions),
        Region::Sphere { radius: outer, .. } if *outer < radius * (1.0 - 1e-9) => Vec::new(),
        Region::Sphere {
            center,
            radius: outer,
        } => match dimensions {
            Dimensions::Two => circle(center.with_z(0.0), outer - radius, spacing),
            Dimensions::Three => ball(*center, outer - radius, count.ceil() as u32),
        },
        _ => {
            let mut unused = ChaCha8Rng::seed_from_u64(file.seed);
            let all = shapes::lattice(&region, dimensions, radius, spacing, 0.0, &mut unused);
            outermost(&all, spacing)
        }
    };
    Some((points, solid))
}

/// Whether there is room for so many particles of each copy.
fn room(path: &str, count: f64, copies: usize, file: &SceneFile, report: &mut Report) -> bool {
    report.room_for(
        path,
        "would hold about",
        count * copies as f64,
        "particles",
        &smaller(file),
    )
}

/// Area of a place in a hexagonal pattern, in squares of its spacing.
const HEXAGON: f64 = 0.866;

/// Layers of particles that fill this length from end to end, at most `spacing` apart.
fn layers(length: f64, radius: f64, spacing: f64) -> f64 {
    if length < 2.0 * radius * (1.0 - 1e-9) {
        return 0.0;
    }
    ((length - 2.0 * radius) / spacing - 1e-6).ceil().max(0.0) + 1.0
}

/// Points of a cubic lattice that have not all six neighbors: the inside of a body touches nothing.
fn outermost(points: &[DVec3], spacing: f64) -> Vec<DVec3> {
    let Some(&origin) = points.first() else {
        return Vec::new();
    };
    let index = |point: DVec3| ((point - origin) / spacing).round().as_ivec3();
    let all: HashSet<IVec3> = points.iter().map(|&point| index(point)).collect();
    let is_inside = |point: DVec3| {
        let at = index(point);
        let mut axes = IVec3::AXES.iter();
        axes.all(|&axis| all.contains(&(at + axis)) && all.contains(&(at - axis)))
    };
    points
        .iter()
        .copied()
        .filter(|&point| !is_inside(point))
        .collect()
}

/// A box covered so that particles touch each of its sides from within.
fn brick(min: DVec3, max: DVec3, radius: f64, spacing: f64, dimensions: Dimensions) -> Vec<DVec3> {
    let along = |axis: usize| -> Vec<f64> {
        if axis >= dimensions.count() {
            return vec![0.0];
        }
        let (low, high) = (min[axis] + radius, max[axis] - radius);
        let layers = layers(max[axis] - min[axis], radius, spacing) as u32;
        let between = f64::from(layers.max(2) - 1);
        let place = |layer: u32| match layers {
            1 => 0.5 * (low + high),
            _ => low + (high - low) * (f64::from(layer) / between),
        };
        (0..layers).map(place).collect()
    };
    let [x, y, z] = [0, 1, 2].map(along);
    let is_end = |along: &[f64], at: usize| at == 0 || at + 1 == along.len();
    let mut points = Vec::new();
    for (j, &y_at) in y.iter().enumerate() {
        for (k, &z_at) in z.iter().enumerate() {
            let on_face = is_end(&y, j) || dimensions == Dimensions::Three && is_end(&z, k);
            let row = x.iter().enumerate().filter(|&(i, _)| on_face || is_end(&x, i));
            points.extend(row.map(|(_, &x_at)| DVec3::new(x_at, y_at, z_at)));
        }
    }
    points
}

/// Evenly spread on a circle.
fn circle(center: DVec3, radius: f64, spacing: f64) -> Vec<DVec3> {
    let count = (TAU * radius / spacing - 1e-6).ceil().max(1.0);
    let place = |k: u32| {
        let (sin, cos) = (TAU * f64::from(k) / count).sin_cos();
        center + radius * DVec3::new(cos, sin, 0.0)
    };
    (0..count as u32).map(place).collect()
}

/// Evenly spread on a sphere, along a spiral that turns by the golden angle (Fibonacci lattice; González 2010).
fn ball(center: DVec3, radius: f64, count: u32) -> Vec<DVec3> {
    let golden = PI * (3.0 - 5f64.sqrt());
    let place = |k: u32| {
        let height = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(count);
        let aside = (1.0 - height * height).sqrt();
        let (sin, cos) = (golden * f64::from(k)).sin_cos();
        center + radius * DVec3::new(aside * cos, height, aside * sin)
    };
    (0..count).map(place).collect()
}
