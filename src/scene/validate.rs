//! From a scene file that follows the schema to a [`Scene`], or to all that is wrong with it.

use std::path::Path;

use glam::DVec3;

use super::allowance::Allowance;
use super::bodies;
use super::boundary::{self, BoundaryParticles};
use super::changes;
use super::color_maps;
use super::coloring::{self, Known};
use super::contact::Law;
use super::filling;
use super::floating;
use super::fluid::{Fluid, Speeds};
use super::fluid_keys;
use super::frame::{Frame, Report};
use super::free_surface;
use super::friction;
use super::grain_keys;
use super::grain_materials;
use super::model::{
    Addressing, Camera, CameraPoint, DensityFrom, FluidSolver, ImagePass, Integrator, Look, PassFiles,
    Projection, Render, SceneFile, SlicingAxis, StartPressure, Storage, View, Wall,
};
use super::rigid;
use super::sizes::{self, Span};
use super::text::number;
use super::{
    Action, Dimensions, Grains, Matter, Neighbors, Particles, Scene, Written, obstacles, schedule, sensors,
    time,
};
use crate::error::Problem;

/// Checks what the schema cannot say, completes what was left out, and turns the rest into numbers. Files named in
/// the scene are looked up in `folder`.
pub(super) fn validate(
    mut file: SceneFile,
    folder: &Path,
    allowance: Allowance,
) -> Result<Scene, Vec<Problem>> {
    let mut report = Report::new(allowance);
    let fillings = filling::fit_spacing(&mut file, &mut report);
    let frame = Frame::new(&file, &mut report);
    if !report.problems.is_empty() {
        // Without a sound domain, what follows would only repeat its problems.
        return Err(report.problems);
    }
    fluid_keys::check(&file, &mut report);
    grain_keys::check(&file, &frame, &mut report);
    sizes::check(&file, &frame, &mut report);
    if file.sizes().is_some() && !report.problems.is_empty() {
        // From sizes that are wrong no radius can be drawn.
        return Err(report.problems);
    }
    rigid::check(&file, &frame, &mut report);
    let mass = mass(&file, frame.dimensions);
    let end = time::end(&file.time);
    let mut colliders = obstacles::colliders(&file, &frame, folder, end, &mut report);
    // When a collider is missing for its own mistake, the others' places in the list no longer name them.
    let all_sound = colliders.len() == file.colliders.len();
    let obstacles = if all_sound { &colliders[..] } else { &[] };
    let bodies::Filled {
        mut particles,
        rigid: mut rigid_bodies,
        bodies,
    } = bodies::fill(&file, &fillings, &frame, obstacles, folder, &mut report);
    let frames = time::frames(&file.time, &mut report);
    let fastest = particles.velocity.iter().map(|v| f64::from(v.length()));
    let fastest = fastest.fold(fastest_wall(&file, &colliders), f64::max);
    let weight = vector(&file.gravity.0);
    let height = weight.normalize_or_zero().abs().dot(frame.max - frame.min);
    let speed = friction::expected_speed(fastest, weight.length(), height);
    let grains = file.grains.as_ref();
    let law = grains.map(|grains| Law::new(grains, frame.dimensions, mass, speed, &mut report));
    let schedule = schedule::schedule(&file, &frame, law.clone(), mass, end, &mut colliders, &mut report);
    let gravity = vector(&file.gravity.0);
    let contacts: Vec<_> = law
        .iter()
        .map(|law| law.contact(mass))
        .chain(schedule.contacts())
        .collect();
    let mut boundary_particles = BoundaryParticles::default();
    let (matter, schedule, time) = match (&file.grains, &file.fluid) {
        (Some(given), _) => {
            let matter = Matter::Grains(Grains {
                radius: given.radius,
                mass,
                sizes: Span::of(&file),
                contact: contacts[0].clone(),
                mixed: grain_materials::are_mixed(&file),
            });
            let hardness = rigid::hardness(&rigid_bodies, frame.dimensions, given.radius, mass);
            let hardened: Vec<_> = contacts
                .iter()
                .map(|contact| super::Contact {
                    friction: contact
                        .friction
                        .as_ref()
                        .map(|friction| Box::new(rigid::hardened(friction, hardness))),
                    ..contact.clone()
                })
                .collect();
            let smallest = file.smallest_radius();
            let time = time::of_grains(&file.time, frames, &hardened, mass, smallest, &mut report);
            (matter.clone(), schedule.actions(matter), time)
        }
        (None, given) => {
            let given = given
                .as_ref()
                .expect("the frame checks that the scene has grains or a fluid");
            let speeds = Speeds {
                particles: &particles,
                gravity,
                bodies: &rigid_bodies,
                walls: fastest_wall(&file, &colliders),
                later_tension: changes::greatest_tension(&file),
            };
            let fluid = Fluid::new(given, &frame, &speeds, &mut report);
            fluid.check_sound("fluid.sound_speed", &mut report);
            start(&file, &fluid, gravity, &bodies, &mut particles, &mut report);
            if all_sound {
                let depth = fluid.wall_depth();
                floating::cover(&mut rigid_bodies, &file, &frame, &colliders, depth, &mut report);
                let walls = boundary::sample(&file, &frame, &colliders, depth, &mut report);
                boundary_particles = floating::before(walls, &rigid_bodies, colliders.len());
            }
            let surface = all_sound
                && report.problems.is_empty()
                && (schedule.adds()
                    || free_surface::there(
                        &particles.position,
                        &boundary_particles.position,
                        &frame,
                        fluid.spacing,
                        fluid.support,
                    ));
            let fluid = fluid
                .with_surface(given, surface, gravity.length(), file.time.integrator())
                .with_viscosity_up_to(
                    changes::greatest_viscosity(&file),
                    gravity.length(),
                    file.time.step,
                );
            let matter = Matter::Fluid(fluid.clone());
            let actions = schedule.actions(matter.clone());
            let later = actions.iter().filter_map(|scheduled| match &scheduled.action {
                Action::SetParameters { matter, .. } => matter.fluid().cloned(),
                Action::Add(_) => None,
            });
            let fluids: Vec<Fluid> = std::iter::once(fluid).chain(later).collect();
            for pair in fluids
                .windows(2)
                .filter(|pair| pair[0].sound_speed != pair[1].sound_speed)
            {
                pair[1].check_sound("events[].set.sound_speed", &mut report);
            }
            let time = time::of_fluid(&file.time, frames, &fluids, gravity.length(), &mut report);
            (matter, actions, time)
        }
    };
    let capacity = capacity(
        &file,
        particles.len(),
        boundary_particles.len(),
        &schedule,
        &mut report,
    );
    if matter
        .grains()
        .is_some_and(|grains| grains.contact.friction.is_some())
    {
        grain_keys::check_count(capacity, &mut report);
    }
    let given = file.fluid.as_ref().and_then(|fluid| fluid.shifting);
    let shifts = given.is_some_and(|strength| strength > 0.0);
    if shifts && file.time.integrator() == Integrator::VelocityVerlet {
        report.problem(
            "fluid.shifting",
            "particles are shifted by `symplectic_euler` only",
            "leave it out, or set time.integrator to `symplectic_euler`",
        );
    }
    let samples = file
        .time
        .sensor_interval
        .map_or(1.0, |interval| 1.0 / (time.fps * interval));
    if !file.sensors.is_empty() && samples > MOST_SAMPLES {
        report.problem(
            "time.sensor_interval",
            format!("{} samples with each frame", number(samples.round())),
            format!(
                "make it longer: at most {} samples are taken with a frame",
                number(MOST_SAMPLES)
            ),
        );
    }
    let sensors = sensors::sensors(
        &file,
        &frame,
        if all_sound { &colliders } else { &[] },
        &mut report,
    );
    let neighbors = neighbors(&file, &frame, &mut report);
    let materials = grain_materials::of_sides(&file, &frame, &mut report);
    let render = render(&file, &frame, &mut report);
    let known = Known {
        file: &file,
        frame: &frame,
        particles: &particles,
        capacity,
        gravity: gravity.length(),
    };
    let color = coloring::coloring(&known, &mut report);
    match color {
        Some(color) if report.problems.is_empty() => Ok(Scene {
            name: file.name.clone(),
            dimensions: frame.dimensions,
            origin: frame.origin,
            domain: super::Domain {
                materials,
                ..frame.domain(file.domain.restitution)
            },
            gravity: gravity.as_vec3(),
            matter,
            particles,
            boundary: boundary_particles,
            capacity,
            colliders,
            rigid_bodies,
            schedule,
            more_fields: Vec::new(),
            sensors,
            neighbors,
            time,
            render,
            color,
            notes: report.notes,
            written: Written::default(),
            file,
        }),
        _ => Err(report.problems),
    }
}

fn vector(numbers: &[f64]) -> DVec3 {
    DVec3::new(numbers[0], numbers[1], numbers.get(2).copied().unwrap_or(0.0))
}

/// The fastest surface or obstacle, m/s.
fn fastest_wall(file: &SceneFile, colliders: &[super::Collider]) -> f64 {
    let sides = file.domain.side_velocities.all();
    let sides = sides.iter().flatten().filter_map(|(_, given)| *given);
    let sides = sides.map(|given| vector(&given.0).length());
    let moves = colliders.iter().flat_map(|collider| collider.path.windows(2));
    let moves = moves.map(|pair| f64::from(pair[0].1.distance(pair[1].1)) / (pair[1].0 - pair[0].0));
    let spins = colliders.iter().filter_map(|collider| match &collider.shape {
        super::ColliderShape::Sphere { radius, .. } | super::ColliderShape::Cylinder { radius, .. } => {
            Some(f64::from(collider.spin.length() * radius))
        }
        _ => None,
    });
    let emitters = file
        .emitters
        .iter()
        .map(|emitter| vector(&emitter.velocity.0).length());
    sides
        .chain(moves)
        .chain(spins)
        .chain(emitters)
        .fold(0.0, f64::max)
}

/// From pressures at the start to densities, by the fluid's speed of sound. `bodies` says which particles
/// belong to each body.
fn start(
    file: &SceneFile,
    fluid: &Fluid,
    gravity: DVec3,
    bodies: &[std::ops::Range<usize>],
    particles: &mut Particles,
    report: &mut Report,
) {
    for (body, range) in file.bodies.iter().zip(bodies) {
        if body.pressure == StartPressure::Hydrostatic && fluid.solver != FluidSolver::Dfsph {
            fluid.settle(&mut particles.position[range.clone()], gravity);
        }
    }
    let deviation = |(i, &pressure): (usize, &f32)| {
        let material = particles.material.get(i).copied().unwrap_or(0) as usize;
        let density = fluid
            .materials
            .get(material)
            .unwrap_or(&fluid.materials[0])
            .density;
        fluid.deviation_at(density, f64::from(pressure)) as f32
    };
    particles.density_deviation = particles
        .start_pressure
        .iter()
        .enumerate()
        .map(deviation)
        .collect();
    // An incompressible fluid finds its pressures in its first steps, whatever it begins with.
    if fluid.density_from == DensityFrom::Summation && fluid.solver != FluidSolver::Dfsph {
        for (i, body) in file.bodies.iter().enumerate() {
            if body.pressure == StartPressure::Hydrostatic {
                report.problem(
                    format!("bodies[{i}].pressure"),
                    "density comes from a summation over positions, so it cannot be set",
                    "leave it out, or set fluid.density_from to `continuity`",
                );
            }
        }
    }
}

/// Of one grain, that of the largest, kilograms: a ball, or a disc one metre thick.
fn mass(file: &SceneFile, dimensions: Dimensions) -> f64 {
    file.density() * sizes::content(file.radius(), dimensions)
}

/// Particles when everything has happened.
fn capacity(
    file: &SceneFile,
    at_start: usize,
    boundary_particles: usize,
    schedule: &[super::Scheduled],
    report: &mut Report,
) -> u32 {
    let added = schedule.iter().map(|scheduled| match &scheduled.action {
        Action::Add(particles) => particles.len(),
        Action::SetParameters { .. } => 0,
    });
    let free = (at_start + added.sum::<usize>()) as u64;
    let all = free + boundary_particles as u64;
    let comes_later = !file.emitters.is_empty() || file.events.iter().any(|event| event.drop.is_some());
    if file.bodies.is_empty() && !comes_later {
        report.problem(
            "",
            "there are no particles",
            "add a body, an emitter, or an event that drops grains",
        );
    } else if free == 0 && report.problems.is_empty() {
        report.problem(
            "",
            "no particle comes before the run ends",
            "let an event or emitter act earlier, or add a body",
        );
    }
    let most = report.allowance.particles;
    if all > most {
        report.problem(
            "",
            format!("{all} particles in all"),
            format!("stay at or below {most}: make bodies smaller or particles larger"),
        );
    }
    all.min(most) as u32
}

fn neighbors(file: &SceneFile, frame: &Frame, report: &mut Report) -> Neighbors {
    let given = &file.neighbors;
    if frame.dimensions == Dimensions::Two && given.slicing_axis == SlicingAxis::Z {
        report.problem(
            "neighbors.slicing_axis",
            "a 2D scene has no z axis",
            "slice across `x` or `y`",
        );
    }
    if given.regions && given.addressing != Addressing::Sliced {
        report.problem(
            "neighbors.regions",
            "only slices can be parted into regions",
            "set neighbors.addressing to `sliced`, or leave regions out",
        );
    }
    let mut neighbors = Neighbors::from(given);
    let periodic = frame.sides.iter().flatten().any(|&side| side == Wall::Periodic);
    let every_step = file
        .fluid
        .as_ref()
        .is_some_and(|fluid| fluid.solver == FluidSolver::Dfsph);
    neighbors.lists_every_step = every_step;
    if every_step {
        neighbors.skin = 0.0;
    }
    if periodic && neighbors.skin <= 0.0 && !every_step {
        report.problem(
            "neighbors.skin",
            "periodic sides need neighbor lists",
            match given.storage {
                Storage::Pool => "choose another storage than `pool`, or set neighbors.skin to 0.1",
                _ => "leave it out, or set it to 0.1",
            },
        );
    }
    if file.time.adaptive && neighbors.skin <= 0.0 && !every_step {
        report.problem(
            "time.adaptive",
            "adaptive steps need neighbor lists, which neighbors.skin 0 and the storage `pool` leave out",
            match given.storage {
                Storage::Pool => {
                    "choose another storage than `pool`, set neighbors.skin to 0.1, or leave it out"
                }
                _ => "leave neighbors.skin out, set it to 0.1, or leave time.adaptive out",
            },
        );
    }
    let crowded = match (&file.fluid, file.sizes()) {
        (Some(_), _) => Some("a fluid's kernel"),
        (None, Some(_)) => Some("two of the largest grains"),
        (None, None) => None,
    };
    if let Some(wide) = crowded.filter(|_| given.storage == Storage::Pool && given.slots < 8) {
        report.notes.push(format!(
            "neighbors.slots is {}: a voxel as wide as {wide} holds more particles, and those beyond find no neighbors",
            given.slots
        ));
    }
    neighbors
}

/// Of sensors, from one frame to the next.
const MOST_SAMPLES: f64 = 1e5;

/// Which scenes can be drawn as water or with a mesh, and the color of water.
fn water(file: &SceneFile, frame: &Frame, report: &mut Report) {
    let help = "choose `splats`, `spheres`, `clay` or `sand`";
    let (look, of_grains) = match file.render.look {
        Look::Water => (Some("water"), "grains are no `water`"),
        Look::Mesh => (
            Some("mesh"),
            "grains have no `mesh`: it is the surface of a fluid",
        ),
        Look::Splats | Look::Spheres | Look::Clay | Look::Sand => (None, ""),
    };
    if let Some(look) = look {
        if frame.dimensions == Dimensions::Two {
            let what = format!("`{look}` is drawn in 3D, and this scene is 2D");
            report.problem("render.look", what, help);
        }
        if file.fluid.is_none() {
            report.problem("render.look", of_grains, help);
        }
    }
    let color = &file.render.water.color;
    if color_maps::parse_hex(color).is_none() {
        report.problem(
            "render.water.color",
            format!("\"{color}\" is not a color"),
            "write six hexadecimal digits: \"#4fa6c4\"",
        );
    }
}

/// Which extra images can be made, and what can be blurred.
fn passes(render: &Render, has_floating_bodies: bool, report: &mut Report) {
    for (key, is_wanted) in [
        ("render.passes", !render.passes.is_empty()),
        ("render.shutter", render.shutter > 0.0),
        ("render.camera.aperture", render.camera.aperture > 0.0),
    ] {
        if is_wanted && !render.follows_particles() {
            report.problem(
                key,
                "a surface that is a mesh has neither extra images nor blur",
                "choose another look than `mesh` for render.look, and for water `screen` for render.water.surface",
            );
        }
    }
    if has_floating_bodies {
        for (key, is_wanted, what) in [
            (
                "render.passes",
                !render.passes.is_empty(),
                "rigid bodies in a fluid are in no extra images",
            ),
            (
                "render.shutter",
                render.shutter > 0.0,
                "rigid bodies in a fluid have no motion blur",
            ),
        ] {
            if is_wanted {
                report.problem(key, what, "leave it out, or leave out such bodies");
            }
        }
    }
    if render.passes.is_empty() {
        return;
    }
    if render.view != View::Scene {
        report.problem(
            "render.passes",
            "extra images show the scene alone",
            "set render.view to `scene`, or leave render.passes out",
        );
    }
    if render.pass_files == PassFiles::Png && render.passes.contains(&ImagePass::Velocity) {
        report.problem(
            "render.passes",
            "PNG files cannot hold `velocity`",
            "set render.pass_files to `exr`, or choose `motion`, which is in pixels",
        );
    }
}

/// Pixels along a side.
const SMALLEST_FRAME: u32 = 16;
const LARGEST_FRAME: u32 = 16_384;

/// How frames look, with the camera in local coordinates.
fn render(file: &SceneFile, frame: &Frame, report: &mut Report) -> Render {
    let mut render = file.render.clone();
    if render
        .size
        .iter()
        .any(|side| !(SMALLEST_FRAME..=LARGEST_FRAME).contains(side))
    {
        let [width, height] = render.size;
        report.problem(
            "render.size",
            format!("{width} × {height} pixels"),
            format!("give {SMALLEST_FRAME} to {LARGEST_FRAME} pixels per side"),
        );
    }
    if render.show.slices && file.neighbors.addressing != Addressing::Sliced {
        report
            .notes
            .push("render.show.slices: this grid has no slices, so none are drawn".into());
    }
    water(file, frame, report);
    let has_floating_bodies = file.fluid.is_some() && file.bodies.iter().any(|body| body.rigid.is_some());
    passes(&render, has_floating_bodies, report);
    render.show.caption &= render.show.overlay;
    if render.light.is_some_and(|light| light == [0.0; 3]) {
        report.problem(
            "render.light",
            "has no direction",
            "point it towards the light, or leave it out",
        );
    }
    let camera = &mut render.camera;
    if camera.axis.is_some() && camera.eye.is_some() {
        report.problem(
            "render.camera",
            "`axis` and `eye` both say where to look from",
            "remove one of them",
        );
    }
    for (key, point) in [("eye", &mut camera.eye), ("target", &mut camera.target)] {
        let Some(point) = point else { continue };
        if let Some(far) = point.iter().find(|x| x.abs() > 1e9) {
            let help = "give numbers between -1e9 and 1e9";
            report.problem(
                format!("render.camera.{key}"),
                format!("{} is too large", number(*far)),
                help,
            );
        }
        *point = frame.local(DVec3::from(*point)).into();
    }
    if camera.eye.is_some() && camera.eye == camera.target {
        report.problem(
            "render.camera",
            "`eye` and `target` are one point",
            "move them apart",
        );
    }
    let is_flat = frame.dimensions == Dimensions::Two
        || camera.axis.is_some()
        || camera.projection == Projection::Orthographic;
    if camera.aperture > 0.0 && is_flat {
        report.problem(
            "render.camera.aperture",
            "an orthographic view has no depth of field",
            "leave it out, or choose a perspective view",
        );
    }
    camera_path(camera, frame, report);
    render
}

/// The path of a camera, in local coordinates.
fn camera_path(camera: &mut Camera, frame: &Frame, report: &mut Report) {
    let key = "render.camera.path";
    let Some(first) = camera.path.first().cloned() else {
        return;
    };
    let given = [
        ("axis", camera.axis.is_some() && first.eye.is_some()),
        ("eye", camera.eye.is_some() && first.eye.is_some()),
        ("target", camera.target.is_some() && first.target.is_some()),
    ];
    for (name, _) in given.iter().filter(|(_, is_twice)| *is_twice) {
        let what = format!("says what `render.camera.{name}` says too");
        report.problem(key, what, "remove one of them");
    }
    let mut before = None;
    for (index, point) in camera.path.iter_mut().enumerate() {
        let key = format!("{key}[{index}]");
        let keys = |point: &CameraPoint| (point.eye.is_some(), point.target.is_some());
        match keys(point) {
            (false, false) => {
                report.problem(
                    &key,
                    "has neither `eye` nor `target`",
                    "give one of them, or both",
                );
            }
            own if own != keys(&first) => {
                let help = "give `eye`, `target` or both, the same at every point";
                report.problem(&key, "has other keys than the first point", help);
            }
            _ if point.eye == point.target => {
                report.problem(&key, "`eye` and `target` are one point", "move them apart");
            }
            _ => {}
        }
        if before.is_some_and(|before| before >= point.at) {
            let help = "put points in order of time, each at a time of its own";
            report.problem(format!("{key}.at"), "is not later than the point before", help);
        }
        before = Some(point.at);
        for place in [&mut point.eye, &mut point.target].into_iter().flatten() {
            if let Some(far) = place.iter().find(|x| x.abs() > 1e9) {
                let help = "give numbers between -1e9 and 1e9";
                report.problem(&key, format!("{} is too large", number(*far)), help);
            }
            *place = frame.local(DVec3::from(*place)).into();
        }
    }
}
