//! Fluids: smoothed particle hydrodynamics (Müller 2003; Monaghan 1994; Rojas 2013, Eq. 1 to 7).
//!
//! A step moves every particle (`shaders/physics/fluid/symplectic_euler.wgsl`), searches neighbors, finds densities and
//! pressures there, and carries them on into the walls. So at the end of a step, and of a frame, all are at one time.

use glam::Vec3;

use super::collider::{Obstacles, velocity_between};
use super::dem::{bounds, has_wall};
use super::formulas::{self, DENSITY, FORCES, Terms};
use super::kernels;
use super::layout::{Fluid, Material, Measure, PACKED_BYTES, Packed, Planes, Rim, Sums};
use super::model::{FromState, Model, OwnFigures, Request, Solver, Written};
use crate::gpu::{BufferPlan, Items, PassPlan, Variant};
use crate::guards::Family;
use crate::neighbors::lists;
use crate::scene::boundary::NO_BODY;
use crate::scene::model::{
    DensityFrom, FluidSolver, Integrator, Kernel, NegativePressure, Slip, ViscosityForm, Wall,
};
use crate::scene::{self, Matter, Scene};

/// Flag of every variant of a fluid.
pub const FLAG: &str = "fluid";
/// Farthest that one step may shift a particle, as a share of the spacing.
const LONGEST_SHIFT: f64 = 0.05;
/// The shift of δ⁺-SPH in units of h × expected speed (Sun 2017, with its h half of the support).
const USUAL_SHIFT: f64 = 4.0;

/// Bytes of a `PairState` (`shaders/physics/fluid/pair_state.wgsl`).
const PAIR_STATE_BYTES: u64 = 2 * PACKED_BYTES;

/// The row of weakly compressible fluids.
pub(super) const MODEL: Model = Model {
    moves: |matter| {
        matter
            .fluid()
            .is_some_and(|fluid| fluid.solver != FluidSolver::Dfsph)
    },
    plan,
    parameters,
    place_obstacles,
    measures_by_voxels: false,
    figures: FIGURES,
    sums,
    from_state: FROM_STATE,
    particle_mass,
    sense_walls: ("physics/fluid/sense_walls", false),
    family: Family::WeaklyCompressible,
};

pub(super) const FIGURES: &[&str] = &[
    "boundary_particles",
    "density_error_mean",
    "density_error_max",
    "clamped_pressures",
    "clamped_densities",
];
/// `fluid_state` holds ρ/ρ₀ − 1 and the pressure, Pa.
pub(super) const FROM_STATE: &[FromState] = &[
    FromState {
        column: "density",
        buffer: "fluid_state",
        width: 2,
        value: |scene, state, material| {
            given(&scene.matter).materials[material].density as f32 * (1.0 + state[0])
        },
    },
    FromState {
        column: "pressure",
        buffer: "fluid_state",
        width: 2,
        value: |_, state, _| state[1],
    },
];

pub(super) fn given(matter: &Matter) -> &scene::fluid::Fluid {
    matter.fluid().expect("this solver moves fluids alone")
}

pub(super) fn particle_mass(scene: &Scene) -> f64 {
    let fluid = given(&scene.matter);
    fluid.materials[0].density * fluid.volume(scene.dimensions)
}

pub(super) fn sums(scene: &Scene, particles: u32, sums: &Sums) -> OwnFigures {
    let clamps = given(&scene.matter).negative_pressure == NegativePressure::Clamp;
    OwnFigures {
        density_error: Some([
            f64::from(sums.density_error) / f64::from(particles.max(1)),
            f64::from(sums.max_density_error),
        ]),
        clamped: clamps.then_some([sums.clamped_pressures, sums.clamped_densities]),
    }
}

/// How fast each obstacle moves its boundary particles.
pub(super) fn place_obstacles(scene: &Scene, _: &Obstacles, from: f64, to: f64) -> Vec<Written> {
    // Without boundary particles there is nothing to move.
    if scene.boundary.is_empty() {
        return Vec::new();
    }
    let velocity = |collider: &scene::Collider| velocity_between(&collider.path, from, to);
    let each = scene.colliders.iter().map(|c| velocity(c).extend(0.0).to_array());
    vec![Written::new("body_velocity", &each.collect::<Vec<_>>())]
}

/// The coefficients of the fluid, and of each of several.
fn parameters(scene: &Scene, matter: &Matter) -> Vec<Written> {
    let fluid = given(matter);
    let mut written = vec![Written::new("fluid", &[coefficients(scene, fluid)])];
    if fluid.materials.len() > 1 {
        written.push(Written::new("materials", &materials(fluid)));
    }
    written
}

pub(super) fn kernel_file(kernel: Kernel) -> &'static str {
    match kernel {
        Kernel::CubicSpline => "physics/fluid/kernels/cubic_spline",
        Kernel::WendlandC2 => "physics/fluid/kernels/wendland_c2",
        Kernel::WendlandC4 => "physics/fluid/kernels/wendland_c4",
        Kernel::QuinticSpline => "physics/fluid/kernels/quintic_spline",
        Kernel::Muller => "physics/fluid/kernels/muller",
    }
}

/// What of a scene decides which formulas act.
pub fn terms(scene: &Scene) -> Terms {
    let fluid = given(&scene.matter);
    // At some time during the run.
    let ever = |has: fn(&scene::fluid::Fluid) -> bool| scene.matters().any(|matter| has(given(matter)));
    let viscous = ever(scene::fluid::Fluid::is_viscous);
    let form = |form: ViscosityForm| viscous && fluid.viscosity_form == form;
    let slips = (!scene.boundary.is_empty() || has_wall(scene, Wall::Planes)) && fluid.slip == Slip::FreeSlip;
    let shifting = fluid.shifting > 0.0;
    let clamped = fluid.negative_pressure == NegativePressure::Clamp;
    let continuity = scene.has_field("density_deviation");
    Terms {
        continuity,
        density_diffusion: continuity && fluid.density_diffusion > 0.0,
        gradient_correction: fluid.gradient_correction,
        clamped,
        controlled: fluid.negative_pressure == NegativePressure::Control,
        pressure_force: fluid.pressure_force,
        muller: fluid.kernel == Kernel::Muller,
        laplacian: form(ViscosityForm::Laplacian),
        monaghan_gingold: form(ViscosityForm::MonaghanGingold),
        stress: scene.has_field("stress"),
        surface_tension: scene.has_field("surface_normal"),
        slips,
        artificial_viscosity: ever(|fluid| fluid.artificial_viscosity > 0.0),
        wall_friction: slips && ever(|fluid| fluid.wall_friction > 0.0),
        shifting,
        // In a fluid without a free surface that may not part, what looks like one is a void that shifting has to fill.
        along_surface: shifting && (fluid.free_surface || clamped),
    }
}

/// What a fluid needs.
fn plan(request: &Request, variant: &mut Variant) -> Solver {
    let &Request {
        scene, statistics, ..
    } = request;
    let fluid = given(&scene.matter);
    let terms = terms(scene);
    let walls = !scene.boundary.is_empty();
    let moving = walls && scene.colliders.iter().any(|collider| !collider.path.is_empty());
    let knows_reach = lists::knows_reach(scene);
    // Periodic sides take boundary particles beyond them back with their first move.
    let rests = knows_reach && !moving && scene.domain.period() == Vec3::ZERO;
    let planes = has_wall(scene, Wall::Planes);
    let faces = planes || has_wall(scene, Wall::Particles);
    let rim = has_wall(scene, Wall::Particles) && has_wall(scene, Wall::Open);
    let several = scene.has_field("material");
    let tension = terms.surface_tension;
    variant
        .flag(FLAG, true)
        .role("kernel", kernel_file(fluid.kernel))
        .constant("GAMMA", fluid.gamma)
        .flag("boundary_particles", walls)
        .flag("moving_boundaries", moving)
        .flag("resting_boundary", rests)
        .flag(
            "velocity_verlet",
            scene.time.integrator == Integrator::VelocityVerlet,
        )
        .flag("continuity", terms.continuity)
        .flag("several_materials", several)
        .flag("viscous_velocities", scene.has_field("viscous_velocity"))
        .flag("slips", terms.slips)
        .flag("mirrored_walls", terms.slips || terms.gradient_correction)
        .flag("clamped_pressure", terms.clamped)
        .flag("gradient_correction", terms.gradient_correction)
        .flag("shifting", terms.shifting)
        .flag("matrices", terms.need_matrices())
        .flag("planes", planes)
        .flag("faces", faces)
        .flag("rim", rim)
        .flag("statistics", statistics);
    formulas::list("force", FORCES, &terms, variant);
    formulas::list("density", DENSITY, &terms, variant);
    if planes {
        variant.constant("PLANE_CELLS", plane_cells(fluid));
    }

    let mut solver = Solver {
        obstacles: Obstacles::of_boundary_particles(scene),
        ..Solver::default()
    };
    let buffers = &mut solver.buffers;
    buffers.push(BufferPlan::uniform(
        "fluid",
        Fluid::LAYOUT.size,
        "coefficients of the fluid",
    ));
    let why = "position, density, velocity and pressure of each particle, as forces load them";
    buffers.push(BufferPlan::storage(
        "pair_state",
        scene.capacity.into(),
        PAIR_STATE_BYTES,
        why,
    ));
    if planes {
        let why = "sides of the domain beyond which the fluid goes on";
        buffers.push(BufferPlan::constant("planes", &planes_of(scene, fluid), why));
    }
    if faces {
        let why = "closed sides, and where they go on beyond open ones";
        buffers.push(BufferPlan::constant("rim", &rim_of(scene, fluid), why));
    }
    if several {
        variant.constant("MATERIALS", fluid.materials.len() as u32);
        let bytes = fluid.materials.len() * Material::LAYOUT.size;
        buffers.push(BufferPlan::uniform("materials", bytes, "the fluids"));
    }
    if walls {
        let why = "boundary particles: velocity of the surface, and whose they are";
        buffers.push(BufferPlan::table("boundary", &boundary(scene), why));
    }
    if moving {
        buffers.push(body_velocity(scene, variant));
    }

    let pass = |file: &str, entry, items, why: &str| {
        PassPlan::new(&format!("physics/fluid/{file}"), entry, items, why)
    };
    let (all, free, reached) = (Items::Particles, Items::FreeParticles, Items::ReachedParticles);
    let euler = scene.time.integrator == Integrator::SymplecticEuler;
    solver.before_search.push(if euler {
        let why = "forces and symplectic Euler (Rojas 2013, Eq. 7)";
        pass("symplectic_euler", "move_fluid", free, why)
    } else {
        let why = "positions move, velocities are predicted (velocity Verlet)";
        pass("drift", "drift_fluid", free, why)
    });
    if walls {
        let items = if rests { reached } else { all };
        let why = "boundary particles move with their bodies, and keep what they have";
        solver
            .before_search
            .push(pass("move_boundary", "move_boundary", items, why));
    }
    solver.before_search.push(PassPlan::new(
        "physics/advance_clock",
        "advance_clock",
        Items::Once,
        "counts the step",
    ));
    let why = match fluid.density_from {
        DensityFrom::Summation => "density by summation (Rojas 2013, Eq. 1), and pressure",
        DensityFrom::Continuity => "density by continuity, and pressure",
    };
    solver
        .after_search
        .push(pass("density", "find_density", free, why));
    if walls {
        let why = "boundary particles take on the fluid's pressure and velocity (Adami 2012)";
        solver
            .after_search
            .push(pass("boundary_state", "extend_to_boundary", reached, why));
    }
    if knows_reach {
        let why = "the state of boundary particles out of reach, which have no fluid beside them";
        solver
            .once_searched
            .push(pass("unreached", "extend_to_unreached", all, why));
    }
    if rests {
        let why = "particles into the `next_` buffers too: steps leave out boundary particles out of reach";
        solver.once_searched.push(PassPlan {
            flipped: true,
            ..PassPlan::new("storage/lists/keep", "keep_particles", all, why)
        });
    }
    if tension {
        let why = "where the surface is, for its tension (Morris 2000)";
        solver
            .after_search
            .push(pass("surface_normal", "find_surface", free, why));
    }
    if terms.stress {
        let why = "velocity gradient and viscous stress (Rojas 2013, Eq. 4)";
        solver.after_search.push(pass("stress", "find_stress", free, why));
    }
    if !euler {
        let why = "forces at the new positions";
        solver
            .after_search
            .push(pass("velocity_verlet", "sum_fluid_forces", free, why));
        solver.after_search.push(PassPlan {
            items: free,
            ..super::kick()
        });
    }
    if statistics {
        buffers.push(BufferPlan::constant(
            "measure",
            &measure(scene),
            "where energies are zero",
        ));
    }
    solver.measure = measures(request);
    solver
}

/// What is measured once a frame: figures for statistics, and columns, each in a pass of its own, so that neither binds too
/// many buffers.
pub(super) fn measures(request: &Request) -> Vec<PassPlan> {
    let pass = |file: &str, entry, why: &str| {
        PassPlan::new(&format!("physics/fluid/{file}"), entry, Items::Particles, why)
    };
    let figures = pass("measure", "measure_fluid", "energies and densities, once a frame");
    let columns = pass("columns", "measure_columns", "measured columns, once a frame");
    let wanted = [
        (request.statistics, figures),
        (request.measures_columns(), columns),
    ];
    let wanted = wanted.into_iter().filter(|(is_wanted, _)| *is_wanted);
    wanted.map(|(_, pass)| pass).collect()
}

/// The fluid's numbers for the shaders.
pub(super) fn coefficients(scene: &Scene, fluid: &scene::fluid::Fluid) -> Fluid {
    let dimensions = scene.dimensions.count();
    let h = fluid.smoothing();
    // Of an incompressible fluid a lattice at rest has exactly rest density, or it would begin by spreading.
    let calibration = match fluid.solver {
        FluidSolver::Dfsph => 1.0 / kernels::lattice_density(fluid.kernel, dimensions, h, fluid.spacing),
        _ => 1.0,
    };
    let scale = |sigma: f64, power: usize| (calibration * sigma / h.powi(power as i32)) as f32;
    let sound = fluid.sound_speed;
    // h as other kernels have it: half of what the kernel reaches.
    let half = fluid.support / 2.0;
    let closed = |axis: usize| match scene.domain.sides[axis] {
        [Wall::Periodic, _] => 0.0,
        _ => 1.0,
    };
    Fluid {
        support: fluid.support as f32,
        inverse_smoothing: (1.0 / h) as f32,
        kernel_scale: scale(kernels::normalization(fluid.kernel, dimensions), dimensions),
        slope_scale: scale(
            kernels::slope_normalization(fluid.kernel, dimensions),
            dimensions + 2,
        ),
        laplacian_scale: scale(kernels::muller_laplacian(dimensions), dimensions + 2),
        volume: fluid.volume(scene.dimensions) as f32,
        density: fluid.materials[0].density as f32,
        viscosity: fluid.materials[0].viscosity as f32,
        stiffness: stiffness(fluid, fluid.materials[0].density),
        background_pressure: fluid.background_pressure as f32,
        inverse_sound_squared: (1.0 / (sound * sound)) as f32,
        diffusion: (2.0 * fluid.density_diffusion * half * sound) as f32,
        artificial_viscosity: (fluid.artificial_viscosity * half * sound) as f32,
        wall_friction: fluid.wall_friction as f32,
        shifting: (USUAL_SHIFT * fluid.shifting * half * fluid.max_speed) as f32,
        shift_limit: (LONGEST_SHIFT * fluid.spacing) as f32,
        kernel_at_spacing: kernels::value(fluid.kernel, dimensions, h, fluid.spacing) as f32,
        smallest_square: (0.01 * half * half) as f32,
        lowest_deviation: -(fluid.max_speed / sound).powi(2) as f32,
        surface_tension: fluid.materials[0].surface_tension as f32,
        wetting: fluid.contact_angle.to_radians().cos() as f32,
        spacing: fluid.spacing as f32,
        closed: [closed(0), closed(1), closed(2), 0.0],
        ..Default::default()
    }
}

fn stiffness(fluid: &scene::fluid::Fluid, density: f64) -> f32 {
    (density * fluid.sound_speed * fluid.sound_speed / f64::from(fluid.gamma)) as f32
}

fn materials(fluid: &scene::fluid::Fluid) -> Vec<Material> {
    let each = fluid.materials.iter().map(|material| Material {
        density: material.density as f32,
        viscosity: material.viscosity as f32,
        stiffness: stiffness(fluid, material.density),
        surface_tension: material.surface_tension as f32,
    });
    each.collect()
}

/// Cells of the lattice along a side of the cube around a particle that the kernel fits into.
fn plane_cells(fluid: &scene::fluid::Fluid) -> u32 {
    2 * (fluid.support / fluid.spacing).ceil() as u32 + 1
}

/// The sides that are planes.
fn planes_of(scene: &Scene, fluid: &scene::fluid::Fluid) -> Planes {
    let (lower, upper) = bounds(scene, |wall| wall == Wall::Planes, 0.0);
    let velocity = scene
        .boundary
        .side_velocity
        .map(|ends| ends.map(|v| [v.x, v.y, v.z, 0.0]));
    let [[x_min, x_max], [y_min, y_max], [z_min, z_max]] = velocity;
    Planes {
        lower,
        upper,
        x_min,
        x_max,
        y_min,
        y_max,
        z_min,
        z_max,
        anchor: scene.domain.min.extend(0.0).into(),
        spacing: fluid.spacing as f32,
        ..Default::default()
    }
}

/// Sides of boundary particles, half a spacing inside, and open ones.
pub(super) fn rim_of(scene: &Scene, fluid: &scene::fluid::Fluid) -> Rim {
    let inset = 0.5 * fluid.spacing as f32;
    let (lower, upper) = bounds(
        scene,
        |wall| matches!(wall, Wall::Particles | Wall::Planes),
        inset,
    );
    let (open_lower, open_upper) = bounds(scene, |wall| wall == Wall::Open, 0.0);
    Rim {
        lower,
        upper,
        open_lower,
        open_upper,
    }
}

/// How fast each obstacle moves its boundary particles.
pub(super) fn body_velocity(scene: &Scene, variant: &mut Variant) -> BufferPlan {
    let bodies = scene.colliders.len();
    variant.constant("BODIES", bodies as u32);
    BufferPlan::uniform(
        "body_velocity",
        bodies * size_of::<Packed>(),
        "how obstacles move",
    )
}

/// Surface velocity of each boundary particle, and the number of its body.
pub(super) fn boundary(scene: &Scene) -> Vec<[f32; 4]> {
    let walls = &scene.boundary;
    let each = walls.surface_velocity.iter().zip(&walls.body);
    each.map(|(v, &body)| {
        let number = if body == NO_BODY { -1.0 } else { body as f32 };
        [v.x, v.y, v.z, number]
    })
    .collect()
}

pub(super) fn measure(scene: &Scene) -> Measure {
    let Vec3 { x, y, z } = scene.domain.min;
    Measure {
        reference: [x, y, z, 0.0],
        ..Default::default()
    }
}
