//! Divergence-free SPH (Bender and Koschier 2015, 2017): an incompressible fluid, whose steps may be as long as its motion
//! allows, since no sound has to be followed.
//!
//! A step finds velocities after all forces but pressure, looks for the pressures that free them of divergence, and moves
//! particles by what they become: an approximate projection (Cummins and Rudman 1999), whose Laplacian joins neighbors only, so
//! that pressures of neighbors cannot come apart. Too much density is undone by and by, as a part of what pressures have to
//! undo. The loop for pressures is recorded as often as it may run; the device lets the rest run on nothing once it has
//! converged (`shaders/physics/dfsph/control.wgsl`). Pressures are never negative, so the fluid has free surfaces.

use super::collider::Obstacles;
use super::dem::has_wall;
use super::fluid::{
    self, FLAG, body_velocity, boundary, coefficients, given, kernel_file, measure, measures, rim_of,
};
use super::kernels;
use super::layout::{Convergence, Dfsph, Fluid, PACKED_BYTES};
use super::model::{Model, Request, Solver, Written};
use super::sensors;
use crate::gpu::{BufferPlan, Items, PassPlan, Repeat, Variant};
use crate::neighbors::storage;
use crate::scene::model::{FluidSolver, Slip, Wall};
use crate::scene::{self, Matter, Scene};

/// Sums that the errors of all particles are added to.
const ERROR_SUMS: u32 = 256;
/// Number of the loop.
pub const DIVERGENCE: u32 = 0;
/// Relaxation of Jacobi's iteration; with the momentum that it has, it converges up to 0.5.
const RELAXATION: f32 = 0.45;

/// The row of incompressible fluids.
pub(super) const MODEL: Model = Model {
    moves: |matter| {
        matter
            .fluid()
            .is_some_and(|fluid| fluid.solver == FluidSolver::Dfsph)
    },
    plan,
    sense_walls: ("physics/dfsph/sense_walls", true),
    parameters,
    ..fluid::MODEL
};

/// The coefficients of the fluid, and what its loops stop at.
fn parameters(scene: &Scene, matter: &Matter) -> Vec<Written> {
    let fluid = given(matter);
    vec![
        Written::new("fluid", &[coefficients(scene, fluid)]),
        Written::new("dfsph", &[settings(scene, fluid)]),
    ]
}

/// What such a fluid needs.
fn plan(request: &Request, variant: &mut Variant) -> Solver {
    let &Request {
        scene, statistics, ..
    } = request;
    let fluid = given(&scene.matter);
    let walls = !scene.boundary.is_empty();
    let moving = walls && scene.colliders.iter().any(|collider| !collider.path.is_empty());
    let faces = has_wall(scene, Wall::Particles);
    let rim = faces && has_wall(scene, Wall::Open);
    // At some time during the run.
    let ever = |has: fn(&scene::fluid::Fluid) -> bool| scene.matters().any(|matter| has(given(matter)));
    let viscous = ever(scene::fluid::Fluid::is_viscous);
    let damped = ever(|fluid| fluid.artificial_viscosity > 0.0);
    variant
        .flag(FLAG, true)
        .role("kernel", kernel_file(fluid.kernel))
        .constant("GAMMA", fluid.gamma)
        .flag("boundary_particles", walls)
        .flag("moving_boundaries", moving)
        .flag("viscosity", viscous)
        .flag("artificial_viscosity", damped)
        .flag("drag", viscous || damped)
        .constant("ERROR_SUMS", ERROR_SUMS)
        .constant("DIVERGENCE_LOOP", DIVERGENCE)
        // What only compressible fluids have, in shaders that they share.
        .without(&["clamped_pressure", "continuity", "several_materials"])
        .flag("slips", walls && fluid.slip == Slip::FreeSlip)
        .flag("rim", rim)
        .flag("faces", faces)
        .flag("statistics", statistics);

    let mut solver = Solver {
        obstacles: Obstacles::of_boundary_particles(scene),
        ..Solver::default()
    };
    let each = u64::from(scene.capacity);
    let listed = match storage::row(scene.neighbors.storage).sorts {
        true => u64::from(scene.first_boundary()),
        false => each,
    };
    solver.buffers.extend([
        BufferPlan::storage("own", listed, 12, "what a pressure solve keeps of each particle"),
        BufferPlan::storage(
            "impulse",
            2 * listed,
            4,
            "pressures before and after a sweep, times a time",
        ),
        BufferPlan::storage(
            "error_sum",
            ERROR_SUMS.into(),
            4,
            "errors of particles, added as whole numbers",
        ),
        BufferPlan::indirect("loop_dispatch", 2, 16, "workgroups of the loop while it goes on"),
        BufferPlan::indirect(
            "check_dispatch",
            1,
            16,
            "a workgroup for the checks of the loop",
        ),
        BufferPlan::storage(
            "convergence",
            1,
            Convergence::LAYOUT.size as u64,
            "iterations and errors of the loops",
        )
        .reported_from(0),
        BufferPlan::uniform("dfsph", Dfsph::LAYOUT.size, "what the loops stop at"),
        BufferPlan::uniform("fluid", Fluid::LAYOUT.size, "coefficients of the fluid"),
    ]);
    if faces {
        let why = "closed sides, and where they go on beyond open ones";
        solver
            .buffers
            .push(BufferPlan::constant("rim", &rim_of(scene, fluid), why));
    }
    if walls {
        let why = "what boundary particles add to the loops";
        solver
            .buffers
            .push(BufferPlan::storage("wall_pull", listed, PACKED_BYTES, why));
        let why = "how pressure that grows with depth beyond walls lifts the fluid";
        solver
            .buffers
            .push(BufferPlan::storage("wall_lift", listed, PACKED_BYTES, why));
        let why = "boundary particles: velocity of the surface, and whose they are";
        solver
            .buffers
            .push(BufferPlan::table("boundary", &boundary(scene), why));
    }
    if moving {
        solver.buffers.push(body_velocity(scene, variant));
    }

    let pass = |file: &str, entry, items, why: &str| {
        PassPlan::new(&format!("physics/dfsph/{file}"), entry, items, why)
    };
    let once = Items::Fixed(1);
    let all = Items::Particles;
    let free = Items::FreeParticles;
    let repeated = |sparse, pass| PassPlan {
        repeat: Some(Repeat {
            number: DIVERGENCE,
            times: fluid.max_iterations,
            sparse,
        }),
        ..pass
    };
    solver.before_search.extend([
        pass(
            "apply_forces",
            "apply_forces",
            free,
            "velocities after all forces but pressure",
        ),
        pass(
            "divergence",
            "find_divergence",
            free,
            "what pressures have to undo",
        ),
        pass("control", "begin_divergence_loop", once, "the loop begins"),
        repeated(
            true,
            pass(
                "control",
                "watch_divergence_loop",
                once,
                "whether the loop goes on, so that its checks run",
            ),
        ),
        repeated(
            false,
            pass(
                "relax",
                "relax",
                Items::Loop(DIVERGENCE),
                "a sweep over the pressure equation, and its errors",
            ),
        ),
        repeated(
            false,
            pass(
                "control",
                "check_divergence",
                Items::LoopOnce(DIVERGENCE),
                "whether pressures have converged",
            ),
        ),
        repeated(
            false,
            pass(
                "relax",
                "relax_again",
                Items::LoopSecond(DIVERGENCE),
                "the next sweep",
            ),
        ),
        pass(
            "divergence_push",
            "correct_velocity",
            free,
            "pressures change velocities",
        ),
    ]);
    solver
        .before_search
        .extend(request.sensors.then(|| sensors::force_pass(scene)).flatten());
    solver
        .before_search
        .push(pass("move", "move_fluid", free, "positions at the step's end"));
    if walls {
        let why = "boundary particles move with their bodies";
        solver
            .before_search
            .push(pass("move_boundary", "move_boundary", all, why));
    }
    solver.before_search.push(PassPlan::new(
        "physics/advance_clock",
        "advance_clock",
        Items::Once,
        "counts the step",
    ));
    solver.after_search.push(pass(
        "find_density",
        "find_density",
        free,
        "density by summation, and how it answers to pressure",
    ));
    if statistics {
        let why = "where energies are zero";
        solver
            .buffers
            .push(BufferPlan::constant("measure", &measure(scene), why));
    }
    solver.measure = measures(request);
    solver
}

/// The loops' numbers for the shaders.
fn settings(scene: &Scene, fluid: &scene::fluid::Fluid) -> Dfsph {
    let given = coefficients(scene, fluid);
    let slope = kernels::steepest(fluid.kernel, scene.dimensions.count());
    let smoothing = 1.0 / f64::from(given.inverse_smoothing);
    let surface = kernels::lattice_surface(fluid.kernel, scene.dimensions.count(), smoothing, fluid.spacing);
    Dfsph {
        divergence_error: fluid.max_divergence_error as f32,
        divergence_iterations: fluid.max_iterations,
        relaxation: RELAXATION,
        steepest: given.volume * given.slope_scale / given.inverse_smoothing * slope as f32,
        surface_density: surface.density as f32,
        surface_slope: surface.slope as f32,
        surface_weight: surface.weight as f32,
    }
}
