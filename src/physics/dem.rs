//! Grains as springs and dashpots (Harada 2007, Eq. 6 to 10; Green 2012).

use glam::Vec3;

use super::Solver;
use super::collider::Obstacles;
use super::layout::{ClampWalls, Collider, Contact, ContactWalls, Measure};
use crate::gpu::{BufferPlan, Items, PassPlan, Variant};
use crate::neighbors::Grid;
use crate::neighbors::grid::voxel_reach;
use crate::scene::column::Column;
use crate::scene::model::{Dashpot, Integrator, Wall};
use crate::scene::{self, Action, Dimensions, Scene};

/// Stands for a wall that is not there, metres; far from every f32 position and safely finite when subtracted.
const FAR: f32 = 1e30;

/// The contact laws that hold at some time during the run.
fn contacts(scene: &Scene, grains: &scene::Grains) -> impl Iterator<Item = scene::Contact> {
    let later = scene
        .schedule
        .iter()
        .filter_map(|scheduled| match &scheduled.action {
            Action::SetParameters { contact, .. } => *contact,
            Action::Add(_) => None,
        });
    std::iter::once(grains.contact).chain(later)
}

pub fn has_wall(scene: &Scene, kind: Wall) -> bool {
    let axes = scene.dimensions.count();
    scene.domain.sides[..axes]
        .iter()
        .flatten()
        .any(|&wall| wall == kind)
}

/// What grains need. `columns` are those that somebody asked for, `statistics` whether figures over all grains are.
pub fn plan(
    scene: &Scene,
    grains: &scene::Grains,
    obstacles: &Obstacles,
    columns: &[Column],
    statistics: bool,
    variant: &mut Variant,
) -> Solver {
    let contact_walls = has_wall(scene, Wall::Contact);
    let clamp_walls = has_wall(scene, Wall::Clamp);
    let ever = |positive: fn(&scene::Contact) -> bool| contacts(scene, grains).any(|c| positive(&c));
    let measured = super::measured(scene, columns, variant);
    variant
        .flag("contact_walls", contact_walls)
        .flag("clamp_walls", clamp_walls)
        .flag("colliders", !obstacles.colliders.is_empty())
        .flag("moving_colliders", obstacles.moving)
        .flag("mesh_colliders", !obstacles.field.is_empty())
        .flag("normal_dashpot", grains.contact.dashpot == Dashpot::Normal)
        .flag("shear", ever(|c| c.shear > 0.0))
        .flag("attraction", ever(|c| c.attraction > 0.0))
        .flag("global_damping", ever(|c| c.global_damping > 0.0))
        .flag("statistics", statistics);

    let mut solver = Solver::default();
    let buffers = &mut solver.buffers;
    buffers.push(BufferPlan::uniform(
        "contact",
        Contact::LAYOUT.size,
        "coefficients of the contact law",
    ));
    if contact_walls {
        let why = "sides of the domain that push back";
        buffers.push(BufferPlan::uniform(
            "contact_walls",
            ContactWalls::LAYOUT.size,
            why,
        ));
    }
    if clamp_walls {
        let why = "sides of the domain that clamp (Green 2012)";
        buffers.push(BufferPlan::uniform("clamp_walls", ClampWalls::LAYOUT.size, why));
    }
    if !obstacles.colliders.is_empty() {
        let count = obstacles.colliders.len() as u64;
        buffers.push(BufferPlan::storage(
            "colliders",
            count,
            Collider::LAYOUT.size as u64,
            "obstacles",
        ));
    }
    if !obstacles.field.is_empty() {
        let why = "signed distances around mesh obstacles";
        buffers.push(BufferPlan::storage(
            "distance_field",
            obstacles.field.len() as u64,
            4,
            why,
        ));
    }

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
        Integrator::SymplecticEuler => {
            let why = "contact forces and symplectic Euler (Rojas 2013, Eq. 7)";
            solver
                .before_search
                .extend([pass("symplectic_euler", "move_grains", why), clock]);
        }
        Integrator::VelocityVerlet => {
            variant.flag("accelerations", true);
            buffers.extend(super::accelerations(scene));
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

    if statistics || !measured.is_empty() {
        buffers.push(BufferPlan::uniform(
            "measure",
            Measure::LAYOUT.size,
            "what measures are divided by",
        ));
        buffers.extend(measured);
        let why = "contacts, energies and measured columns of each grain, once a frame";
        solver.measure.push(pass("measure", "measure_grains", why));
    }
    solver
}

/// The contact law's coefficients for the shaders.
pub fn contact_values(grains: &scene::Grains, contact: &scene::Contact) -> Contact {
    Contact {
        spring: contact.spring as f32,
        damping: contact.damping as f32,
        wall_damping: contact.wall_damping as f32,
        shear: contact.shear as f32,
        attraction: contact.attraction as f32,
        global_damping: contact.global_damping as f32,
        diameter: (2.0 * grains.radius) as f32,
        inverse_mass: (1.0 / grains.mass) as f32,
    }
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

pub fn contact_walls(scene: &Scene) -> ContactWalls {
    let (lower, upper) = bounds(scene, |wall| wall == Wall::Contact, 0.0);
    ContactWalls { lower, upper }
}

pub fn clamp_walls(scene: &Scene) -> ClampWalls {
    let (lower, upper) = bounds(scene, |wall| wall == Wall::Clamp, scene.radius() as f32);
    ClampWalls {
        lower,
        upper,
        restitution: scene.domain.restitution,
        ..Default::default()
    }
}

/// Where particles count as lost: a diameter beyond a side that is closed.
pub fn guard_bounds(scene: &Scene) -> ([f32; 4], [f32; 4]) {
    bounds(
        scene,
        |wall| !matches!(wall, Wall::Open | Wall::Periodic),
        -2.0 * scene.radius() as f32,
    )
}

pub fn measure(scene: &Scene, grains: &scene::Grains, grid: &Grid) -> Measure {
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
