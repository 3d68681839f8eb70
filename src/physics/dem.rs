//! Grains as springs and dashpots (Harada 2007, Eq. 6 to 10; Green 2012). Of grains of several sizes, coefficients and measures
//! are of the largest (`shaders/common/sizes.wgsl`).

use glam::Vec3;

use super::bodies;
use super::collider::{Obstacles, offset_at, velocity_between};
use super::fluid::FLAG;
use super::layout::{
    ClampWalls, Collider, Contact, ContactWalls, FrictionalContact, Measure, Motion, Pairing,
};
use super::model::{Model, OwnFigures, Request, Solver, Written};
use crate::gpu::{BufferPlan, Items, PassPlan, Variant};
use crate::guards::Family;
use crate::neighbors::grid::voxel_reach;
use crate::neighbors::{Grid, lists};
use crate::scene::field::{contact_slots, contact_words};
use crate::scene::friction::{self, Friction};
use crate::scene::model::{ContactLaw, Dashpot, Integrator, RollingResistance, Wall};
use crate::scene::{self, ColliderShape, Dimensions, Matter, Scene};

/// Stands for a wall that is not there, metres; far from every f32 position and safely finite when subtracted.
const FAR: f32 = 1e30;

/// The row of grains.
pub(super) const MODEL: Model = Model {
    moves: |matter| matter.grains().is_some(),
    plan,
    parameters,
    place_obstacles,
    measures_by_voxels: true,
    figures: &["contacts", "max_overlap"],
    sums: |_, _, _| OwnFigures::default(),
    from_state: &[],
    particle_mass: |scene| grains(&scene.matter).mass,
    sense_walls: ("physics/dem/sense_walls", false),
    family: Family::Grains,
};

fn grains(matter: &Matter) -> &scene::Grains {
    matter.grains().expect("this solver moves grains alone")
}

pub fn has_wall(scene: &Scene, kind: Wall) -> bool {
    let axes = scene.dimensions.count();
    scene.domain.sides[..axes]
        .iter()
        .flatten()
        .any(|&wall| wall == kind)
}

/// What grains need.
fn plan(request: &Request, variant: &mut Variant) -> Solver {
    let &Request {
        scene,
        statistics,
        grid,
        ..
    } = request;
    let obstacles = Obstacles::new(scene);
    let given = grains(&scene.matter);
    let contact_walls = has_wall(scene, Wall::Contact);
    let clamp_walls = has_wall(scene, Wall::Clamp);
    let has_cylinder = scene
        .colliders
        .iter()
        .any(|collider| matches!(collider.shape, ColliderShape::Cylinder { .. }));
    // At some time during the run.
    let ever = |positive: fn(&scene::Contact) -> bool| {
        scene.matters().any(|matter| positive(&grains(matter).contact))
    };
    variant
        // What only fluids have, in shaders that they share.
        .without(&[FLAG, "boundary_particles"])
        .constant("COLLIDER_PLANE", Collider::PLANE)
        .constant("COLLIDER_BOX", Collider::BOX)
        .constant("COLLIDER_MESH", Collider::MESH)
        .constant("COLLIDER_CYLINDER", Collider::CYLINDER)
        .flag("contact_walls", contact_walls)
        .flag("clamp_walls", clamp_walls)
        .flag("colliders", !obstacles.colliders.is_empty())
        .flag("moving_colliders", obstacles.moving)
        .flag("mesh_colliders", !obstacles.field.is_empty())
        .flag("cylinders", has_cylinder)
        .flag(
            "spinning_colliders",
            scene.colliders.iter().any(|c| c.spin != Vec3::ZERO),
        )
        .flag("rotation", given.contact.friction.is_some())
        .flag("normal_dashpot", given.contact.dashpot == Dashpot::Normal)
        .flag("shear", ever(|c| c.shear > 0.0))
        .flag("attraction", ever(|c| c.attraction > 0.0))
        .flag("global_damping", ever(|c| c.global_damping > 0.0))
        .flag("statistics", statistics);

    let mut solver = Solver::default();
    let buffers = &mut solver.buffers;
    let size = match &given.contact.friction {
        Some(friction) => {
            set_friction(scene, given, friction, variant);
            if !friction.pairings.is_empty() {
                let size = Pairing::LAYOUT.size * friction.pairings.len();
                let why = "coefficients of each two materials";
                buffers.push(BufferPlan::uniform("pairings", size, why));
            }
            FrictionalContact::LAYOUT.size
        }
        None => Contact::LAYOUT.size,
    };
    buffers.push(BufferPlan::uniform(
        "contact",
        size,
        "coefficients of the contact law",
    ));
    if contact_walls {
        let why = "sides of the domain that push back";
        buffers.push(BufferPlan::constant(
            "contact_walls",
            &walls_that_push(scene),
            why,
        ));
    }
    if clamp_walls {
        let why = "sides of the domain that clamp (Green 2012)";
        buffers.push(BufferPlan::constant("clamp_walls", &walls_that_clamp(scene), why));
    }
    if !obstacles.colliders.is_empty() {
        variant.constant("COLLIDERS", obstacles.colliders.len() as u32);
        buffers.push(BufferPlan::uniforms(
            "colliders",
            &obstacles.colliders,
            "obstacles",
        ));
    }
    if !obstacles.field.is_empty() {
        let why = "signed distances around mesh obstacles";
        buffers.push(BufferPlan::table("distance_field", &obstacles.field, why));
    }

    buffers.extend(bodies::plan(scene, given.mass, variant));
    let has_bodies = !scene.rigid_bodies.is_empty();

    let pass = |file: &str, entry, why: &str| {
        PassPlan::new(&format!("physics/dem/{file}"), entry, Items::Particles, why)
    };
    let clock = PassPlan::new(
        "physics/advance_clock",
        "advance_clock",
        Items::Once,
        "counts the step",
    );
    match scene.time.integrator {
        _ if given.contact.friction.is_some() => {
            let bytes = Motion::LAYOUT.size as u64;
            let why = "accelerations and angular accelerations by contacts and weight";
            let each = u64::from(scene.capacity);
            buffers.push(BufferPlan::storage("contact_acceleration", each, bytes, why));
            solver.before_search.push(pass(
                "sum_contacts",
                "sum_contact_forces",
                "contact forces, torques, and what contacts remember",
            ));
            if has_bodies {
                solver.before_search.push(bodies::move_bodies());
                // Where no step does without a search, what follows each search follows each step.
                match lists::wanted(scene) {
                    true => solver.once_searched.push(bodies::find_members()),
                    false => solver.after_search.push(bodies::find_members()),
                }
            }
            solver.before_search.extend([
                pass(
                    "leapfrog",
                    "leap_grains",
                    "velocities half a step later, positions (velocity Verlet)",
                ),
                pass("turn", "turn_grains", "angular velocities half a step later"),
            ]);
            if has_bodies {
                solver.before_search.push(bodies::move_members());
            }
            solver.before_search.push(clock);
        }
        Integrator::SymplecticEuler => {
            let why = "contact forces and symplectic Euler (Rojas 2013, Eq. 7)";
            solver
                .before_search
                .extend([pass("symplectic_euler", "move_grains", why), clock]);
        }
        Integrator::VelocityVerlet => {
            let drift = pass(
                "drift",
                "drift",
                "positions move, velocities are predicted (velocity Verlet)",
            );
            solver.before_search.extend([drift, clock]);
            solver.after_search.extend([
                pass(
                    "velocity_verlet",
                    "sum_forces",
                    "contact forces at the new positions",
                ),
                super::kick(),
            ]);
        }
    }

    if statistics || request.measures_columns() {
        buffers.push(BufferPlan::constant(
            "measure",
            &measure(scene, given, grid),
            "what measures are divided by",
        ));
    }
    // One pass for figures and for columns would bind too many buffers where grains rotate, which have more to read.
    let apart = given.contact.friction.is_some();
    let of_contacts = request.has_column("contacts") || request.has_column("pressure");
    if statistics || of_contacts && !apart {
        let why = "contacts, energies and columns that contacts give, once a frame";
        solver.measure.push(pass("measure", "measure_grains", why));
    }
    if of_contacts && apart {
        let why = "columns that contacts give, once a frame";
        solver
            .measure
            .push(pass("measure_columns", "measure_columns", why));
    }
    if request.has_column("density") {
        let why = "density around each grain, once a frame";
        solver
            .measure
            .push(pass("measure_density", "measure_density", why));
    }
    solver.notes.clone_from(&obstacles.notes);
    solver.obstacles = Obstacles {
        // The buffer holds them now.
        field: Vec::new(),
        ..obstacles
    };
    solver
}

/// What the shaders of grains that rotate are made of.
fn set_friction(scene: &Scene, grains: &scene::Grains, friction: &Friction, variant: &mut Variant) {
    let rolls = friction.rolling == Some(RollingResistance::Spring);
    variant
        .flag("rolling", friction.rolling.is_some())
        .flag("rolling_spring", rolls)
        .flag("cohesion", friction.cohesion_range > 0.0)
        .flag("materials", friction.materials > 1)
        .flag("mixed_grains", grains.mixed)
        .flag(
            "springs_by_mass",
            grains.sizes.is_some_and(|sizes| sizes.springs_by_mass),
        )
        .constant("MATERIALS", friction.materials as u32)
        .role("contact_law", contact_law(friction.law))
        .constant("CONTACT_SLOTS", contact_slots(scene))
        .constant("CONTACT_WORDS", contact_words(scene.dimensions, rolls));
    if let Some(rolling) = friction.rolling {
        variant.role("rolling_law", rolling_law(rolling));
    }
}

/// Shader file of a contact law of grains that rotate.
fn contact_law(law: ContactLaw) -> &'static str {
    match law {
        ContactLaw::Hertz => "physics/dem/contact_laws/hertz",
        ContactLaw::Linear | ContactLaw::SpringDashpot => "physics/dem/contact_laws/linear",
    }
}

/// Shader file of what resists rolling.
fn rolling_law(rolling: RollingResistance) -> &'static str {
    match rolling {
        RollingResistance::Spring => "physics/dem/rolling/spring",
        RollingResistance::ConstantTorque => "physics/dem/rolling/constant_torque",
    }
}

/// The contact law's coefficients.
fn parameters(_: &Scene, matter: &Matter) -> Vec<Written> {
    let grains = grains(matter);
    let contact = &grains.contact;
    if let Some(friction) = &contact.friction {
        let contact = FrictionalContact {
            grains: pairing(&friction.grains),
            walls: pairing(&friction.walls),
            diameter: (2.0 * grains.radius) as f32,
            reach: (friction.reach(grains.radius) * 2.0 * grains.radius) as f32,
            inverse_mass: (1.0 / grains.mass) as f32,
            inverse_inertia: (1.0 / friction.inertia) as f32,
            inertia: friction.inertia as f32,
            global_damping: contact.global_damping as f32,
            farthest: FAR,
            cohesion_range: friction.cohesion_range as f32,
        };
        let pairings: Vec<Pairing> = friction.pairings.iter().map(pairing).collect();
        let table = (!pairings.is_empty()).then(|| Written::new("pairings", &pairings));
        return std::iter::once(Written::new("contact", &[contact]))
            .chain(table)
            .collect();
    }
    let contact = Contact {
        spring: contact.spring as f32,
        damping: contact.damping as f32,
        wall_damping: contact.wall_damping as f32,
        shear: contact.shear as f32,
        attraction: contact.attraction as f32,
        global_damping: contact.global_damping as f32,
        diameter: (2.0 * grains.radius) as f32,
        inverse_mass: (1.0 / grains.mass) as f32,
    };
    vec![Written::new("contact", &[contact])]
}

/// Coefficients as shaders read them.
fn pairing(pairing: &friction::Pairing) -> Pairing {
    Pairing {
        stiffness: pairing.stiffness as f32,
        damping: pairing.damping as f32,
        shear_stiffness: pairing.shear_stiffness as f32,
        shear_damping: pairing.shear_damping as f32,
        friction: pairing.friction as f32,
        rolling_limit: pairing.rolling_limit as f32,
        rolling_stiffness: pairing.rolling_stiffness as f32,
        rolling_damping: pairing.rolling_damping as f32,
        rolling_inertia: pairing.rolling_inertia as f32,
        cohesion: pairing.cohesion as f32,
        ..Default::default()
    }
}

/// Shapes with their offsets and velocities, and a clock that begins anew.
fn place_obstacles(scene: &Scene, obstacles: &Obstacles, from: f64, to: f64) -> Vec<Written> {
    let mut moved = obstacles.colliders.clone();
    for (collider, placed) in moved.iter_mut().zip(&scene.colliders) {
        let offset = offset_at(&placed.path, from);
        let velocity = velocity_between(&placed.path, from, to);
        collider.offset = [offset.x, offset.y, offset.z, 0.0];
        collider.velocity = [velocity.x, velocity.y, velocity.z, 0.0];
    }
    vec![
        Written::new("colliders", &moved),
        // The first field of `Clock`.
        Written::new("clock", &[0u32]),
    ]
}

/// Bounds with the sides that are not of this kind moved far away.
pub fn bounds(scene: &Scene, kind: impl Fn(Wall) -> bool, inset: f32) -> ([f32; 4], [f32; 4]) {
    let mut lower = [-FAR; 4];
    let mut upper = [FAR; 4];
    for axis in 0..scene.dimensions.count() {
        if kind(scene.domain.sides[axis][0]) {
            lower[axis] = scene.domain.min[axis] + inset;
        }
        if kind(scene.domain.sides[axis][1]) {
            upper[axis] = scene.domain.max[axis] - inset;
        }
    }
    (lower, upper)
}

fn walls_that_push(scene: &Scene) -> ContactWalls {
    let (lower, upper) = bounds(scene, |wall| wall == Wall::Contact, 0.0);
    let materials = |end: usize| {
        let [x, y, z] = scene.domain.materials;
        [x[end] as f32, y[end] as f32, z[end] as f32, 0.0]
    };
    ContactWalls {
        lower,
        upper,
        lower_materials: materials(0),
        upper_materials: materials(1),
    }
}

fn walls_that_clamp(scene: &Scene) -> ClampWalls {
    let (lower, upper) = bounds(scene, |wall| wall == Wall::Clamp, scene.radius() as f32);
    ClampWalls {
        lower,
        upper,
        restitution: scene.domain.restitution,
        ..Default::default()
    }
}

fn measure(scene: &Scene, grains: &scene::Grains, grid: &Grid) -> Measure {
    use std::f64::consts::PI;
    let radius = grains.radius;
    let side = f64::from(grid.side);
    let row = f64::from(2 * voxel_reach(scene) + 1);
    let (surface, block_volume) = match scene.dimensions {
        Dimensions::Two => (2.0 * PI * radius, (row * side).powi(2)),
        Dimensions::Three => (4.0 * PI * radius * radius, (row * side).powi(3)),
    };
    let Vec3 { x, y, z } = scene.domain.min;
    Measure {
        mass: grains.mass as f32,
        surface: surface as f32,
        block_volume: block_volume as f32,
        reference: [x, y, z, 0.0],
        ..Default::default()
    }
}
