//! Divergence-free SPH (Bender and Koschier 2015, 2017): an incompressible fluid, whose steps may be as long as its motion
//! allows, since no sound has to be followed.
//!
//! A step finds velocities after all forces but pressure, and looks for the pressures that free them of divergence: an
//! approximate projection (Cummins and Rudman 1999), whose Laplacian joins neighbors only, so that pressures of neighbors cannot
//! come apart (`shaders/physics/dfsph/relax.wgsl`). What it does not see is a remainder, which one iteration a step keeps up
//! (`shaders/physics/dfsph/remainder.wgsl`). A second loop corrects where particles go, so that densities do not exceed the
//! rest density; what it corrects does not become motion. Viscosity that would make steps much shorter is implicit
//! (`src/physics/implicit_viscosity.rs`). Loops are recorded as often as they may run; the device lets the rest run on nothing
//! once they have converged (`shaders/physics/dfsph/control.wgsl`). Pressures are never negative, so the fluid has free surfaces.

use super::collider::Obstacles;
use super::dem::has_wall;
use super::floating;
use super::fluid::{
    self, FLAG, body_velocity, boundary, coefficients, given, kernel_file, measure, measures, rim_of,
};
use super::implicit_viscosity;
use super::kernels;
use super::layout::{Convergence, Dfsph, Fluid, PACKED_BYTES};
use super::model::{Model, Request, Solver, Written};
use super::sensors;
use crate::gpu::{BufferPlan, Items, PassPlan, Repeat, Variant};
use crate::guards::Family;
use crate::neighbors::storage;
use crate::scene::model::{FluidSolver, Slip, Wall};
use crate::scene::{self, Matter, Scene};

/// Sums that the errors of all particles are added to.
const ERROR_SUMS: u32 = 256;
/// Numbers of the loops.
pub const DENSITY: u32 = 0;
pub const DIVERGENCE: u32 = 1;
pub const VISCOSITY: u32 = 2;
/// Relaxation of Jacobi's sweeps; with the momentum that the loop of pressure has, they converge up to 0.5.
const RELAXATION: f32 = 0.45;
/// The same in the loop of density, and the share of an iteration's step that the next one goes on with: together they converge
/// in splashes, where 0.45 and 0.5 do not.
const DENSITY_RELAXATION: f32 = 0.3;
const MOMENTUM: f32 = 0.7;
/// Share of what corrected densities in the step before that a step begins with. Dam break in 3D, 14,500 particles, mean
/// iterations when the water meets the wall: 11 without, 4 with 0.9.
const WARM_CORRECTION: f32 = 0.9;

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
    family: Family::Incompressible,
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

pub(super) const WATCH: &str = "whether the loop goes on, so that its checks run";

pub(super) fn pass(file: &str, entry: &str, items: Items, why: &str) -> PassPlan {
    PassPlan::new(&format!("physics/dfsph/{file}"), entry, items, why)
}

/// A pass of a loop, recorded as often as the loop may run; a sparse one at its powers of two.
pub(super) fn repeated(fluid: &scene::fluid::Fluid, number: u32, sparse: bool, pass: PassPlan) -> PassPlan {
    PassPlan {
        repeat: Some(Repeat {
            number,
            times: fluid.max_iterations,
            sparse,
        }),
        ..pass
    }
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
    let implicit = fluid.implicit_viscosity;
    let explicit = viscous && !implicit;
    let damped = ever(|fluid| fluid.artificial_viscosity > 0.0);
    let wall_shear = implicit && walls && fluid.slip == Slip::NoSlip;
    variant
        .flag(FLAG, true)
        .role("kernel", kernel_file(fluid.kernel))
        .constant("GAMMA", fluid.gamma)
        .flag("boundary_particles", walls)
        .flag("moving_boundaries", moving)
        .flag("viscosity", explicit)
        .flag("implicit_viscosity", implicit)
        .flag("wall_shear", wall_shear)
        .flag("artificial_viscosity", damped)
        .flag("drag", explicit || damped)
        .constant("ERROR_SUMS", ERROR_SUMS)
        .constant("DENSITY_LOOP", DENSITY)
        .constant("DIVERGENCE_LOOP", DIVERGENCE)
        .constant("VISCOSITY_LOOP", VISCOSITY)
        // What only compressible fluids have, in shaders that they share.
        .without(&["clamped_pressure", "continuity", "several_materials"])
        .flag("slips", walls && fluid.slip == Slip::FreeSlip)
        .flag("rim", rim)
        .flag("faces", faces)
        .flag("statistics", statistics);

    let mut solver = Solver {
        obstacles: Obstacles::of_boundary_particles(scene),
        buffers: floating::plan(scene, (fluid::MODEL.particle_mass)(scene), variant),
        ..Solver::default()
    };
    // A vector more where there is drag.
    let own_bytes = 32 + if explicit || damped { PACKED_BYTES } else { 0 };
    let loops = if implicit { 3 } else { 2 };
    let each = u64::from(scene.capacity);
    let listed = match storage::row(scene.neighbors.storage).sorts {
        true => u64::from(scene.first_boundary()),
        false => each,
    };
    solver.buffers.extend([
        BufferPlan::storage("own", listed, own_bytes, "what the loops keep of each particle"),
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
        BufferPlan::indirect(
            "loop_dispatch",
            2 * loops,
            16,
            "workgroups of the loops that go on",
        ),
        BufferPlan::indirect(
            "check_dispatch",
            loops,
            16,
            "a workgroup for the checks of those loops",
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
        let why = "what boundary particles add to the loops, the same in each iteration";
        solver
            .buffers
            .push(BufferPlan::storage("walls", listed, 2 * PACKED_BYTES, why));
        let why = "boundary particles: velocity of the surface, and whose they are";
        solver
            .buffers
            .push(BufferPlan::table("boundary", &boundary(scene), why));
    }
    if moving {
        solver.buffers.push(body_velocity(scene, variant));
    }

    let once = Items::Fixed(1);
    let all = Items::Particles;
    let free = Items::FreeParticles;
    let density = Items::Loop(DENSITY);
    let repeated = |number, sparse, pass| repeated(fluid, number, sparse, pass);
    solver.before_search.push(pass(
        "apply_forces",
        "apply_forces",
        free,
        "velocities after all forces but pressure",
    ));
    if implicit {
        solver
            .buffers
            .extend(implicit_viscosity::buffers(scene, listed, wall_shear));
        solver.notes.push(implicit_viscosity::why(scene, fluid));
        solver.before_search.extend(implicit_viscosity::passes(fluid));
    }
    solver.before_search.extend(floating::begin(scene));
    solver.before_search.extend([
        pass(
            "divergence",
            "find_divergence",
            free,
            "what pressures have to undo",
        ),
        pass("control", "begin_divergence_loop", once, "the loop begins"),
        repeated(
            DIVERGENCE,
            true,
            pass("control", "watch_divergence_loop", once, WATCH),
        ),
    ]);
    solver.before_search.extend(floating::answer(scene, fluid, false));
    solver.before_search.extend([
        repeated(
            DIVERGENCE,
            false,
            pass(
                "relax",
                "relax",
                Items::Loop(DIVERGENCE),
                "a sweep over the pressure equation, and its errors",
            ),
        ),
        repeated(
            DIVERGENCE,
            false,
            pass(
                "control",
                "check_divergence",
                Items::LoopOnce(DIVERGENCE),
                "whether pressures have converged",
            ),
        ),
    ]);
    solver.before_search.extend(floating::answer(scene, fluid, true));
    solver.before_search.extend([
        repeated(
            DIVERGENCE,
            false,
            pass(
                "relax",
                "relax_again",
                Items::LoopSecond(DIVERGENCE),
                "the next sweep",
            ),
        ),
        pass(
            "remainder",
            "add_remainder",
            free,
            "pressures, and what acts with them",
        ),
        pass(
            "divergence_push",
            "correct_velocity",
            free,
            "pressures change velocities",
        ),
    ]);
    solver.before_search.extend(floating::push(scene, false));
    solver.before_search.push(pass(
        "remainder",
        "find_remainder",
        free,
        "divergence that the compact equation does not see",
    ));
    solver.before_search.extend(floating::push(scene, true));
    solver
        .before_search
        .extend(request.sensors.then(|| sensors::force_pass(scene)).flatten());
    solver.before_search.extend([
        pass(
            "finish_velocity",
            "finish_velocity",
            free,
            "an iteration against it changes velocities; corrections of the step before act on where particles go",
        ),
        pass(
            "control",
            "begin_density_loop",
            once,
            "the loop of density begins",
        ),
        repeated(DENSITY, true, pass("control", "watch_density_loop", once, WATCH)),
        repeated(
            DENSITY,
            false,
            pass(
                "density_loop",
                "predict_density",
                density,
                "density at the step's end, and the impulse against it",
            ),
        ),
        repeated(
            DENSITY,
            false,
            pass(
                "control",
                "check_density",
                Items::LoopOnce(DENSITY),
                "whether density has converged",
            ),
        ),
    ]);
    solver.before_search.extend([
        repeated(
            DENSITY,
            false,
            pass(
                "density_push",
                "push_apart",
                Items::LoopSecond(DENSITY),
                "impulses change where particles go",
            ),
        ),
        pass("move", "move_fluid", free, "positions at the step's end"),
    ]);
    if walls {
        let why = "boundary particles move with their bodies";
        solver
            .before_search
            .push(pass("move_boundary", "move_boundary", all, why));
    }
    solver.before_search.extend(floating::go(scene));
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
    solver.after_search.extend(floating::find(scene));
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
    let smoothing = 1.0 / f64::from(given.inverse_smoothing);
    let [shear, far_shear] = kernels::shear(fluid.kernel, scene.dimensions.count(), smoothing, fluid.spacing);
    let slope = kernels::steepest(fluid.kernel, scene.dimensions.count());
    let lattice = kernels::lattice(fluid.kernel, scene.dimensions.count(), smoothing, fluid.spacing);
    let slope_volume = given.volume / lattice.gradient as f32;
    Dfsph {
        density_error: fluid.max_density_error as f32,
        divergence_error: fluid.max_divergence_error as f32,
        density_iterations: fluid.max_iterations,
        divergence_iterations: fluid.max_iterations,
        relaxation: RELAXATION,
        density_relaxation: DENSITY_RELAXATION,
        momentum: MOMENTUM,
        warm_correction: WARM_CORRECTION,
        slope_volume,
        lattice_gradient: lattice.gradient as f32,
        steepest: slope_volume * given.slope_scale / given.inverse_smoothing * slope as f32,
        surface_density: lattice.surface_density as f32,
        surface_slope: lattice.surface_slope as f32,
        surface_weight: lattice.surface_weight as f32,
        viscosity_error: fluid.max_viscosity_error as f32,
        viscosity_iterations: fluid.max_iterations,
        speed: fluid.max_speed as f32,
        shear: shear as f32,
        far_shear: far_shear as f32,
    }
}
