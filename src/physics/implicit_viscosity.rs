//! Viscosity of an incompressible fluid that would make steps much shorter: a loop before that of pressure finds what it does in a
//! step of any length (Weiler et al. 2018; `shaders/physics/dfsph/damp.wgsl`).

use super::dfsph::{VISCOSITY, WATCH, pass, repeated};
use super::fluid::given;
use super::layout::{Damping, PACKED_BYTES};
use crate::gpu::{BufferPlan, Items, PassPlan};
use crate::scene::Scene;
use crate::scene::fluid::Fluid;
use crate::scene::text::number;

/// Buffers of the loop, for so many particles of the fluid; walls take part where they shear it.
pub(super) fn buffers(scene: &Scene, listed: u64, wall_shear: bool) -> [BufferPlan; 3] {
    // Those of damping.wgsl.
    let sections = match wall_shear {
        true => 4 + scene.dimensions.count() as u64,
        false => 3,
    };
    let why = "velocities before and after a sweep of viscosity, and what walls do to them";
    [
        BufferPlan::storage("damped", sections * listed, PACKED_BYTES, why),
        BufferPlan::storage(
            "damping",
            1,
            Damping::LAYOUT.size as u64,
            "where the loop of viscosity is",
        ),
        BufferPlan::storage(
            "shear_bound",
            1,
            4,
            "a bound of what viscosity multiplies velocities by",
        ),
    ]
}

/// Behind all other forces but pressure.
pub(super) fn passes(fluid: &Fluid) -> [PassPlan; 7] {
    let once = Items::Fixed(1);
    let free = Items::FreeParticles;
    let repeated = |sparse, pass| repeated(fluid, VISCOSITY, sparse, pass);
    [
        pass(
            "begin_damping",
            "begin_damping",
            free,
            "what walls do in the loop of viscosity",
        ),
        pass(
            "control",
            "begin_viscosity_loop",
            once,
            "the loop of viscosity begins",
        ),
        repeated(true, pass("control", "watch_viscosity_loop", once, WATCH)),
        repeated(
            false,
            pass(
                "damp",
                "damp",
                Items::Loop(VISCOSITY),
                "a sweep over the equation of viscosity, and its errors",
            ),
        ),
        repeated(
            false,
            pass(
                "control",
                "check_viscosity",
                Items::LoopOnce(VISCOSITY),
                "whether velocities have converged",
            ),
        ),
        repeated(
            false,
            pass(
                "damp",
                "damp_again",
                Items::LoopSecond(VISCOSITY),
                "the next sweep",
            ),
        ),
        pass(
            "begin_damping",
            "end_damping",
            free,
            "velocities after all forces but pressure",
        ),
    ]
}

/// What a plan says of it.
pub(super) fn why(scene: &Scene, fluid: &Fluid) -> String {
    let greatest = scene
        .matters()
        .map(|matter| given(matter).materials[0])
        .map(|material| material.viscosity / material.density)
        .fold(0.0, f64::max);
    let explicit = fluid.viscous_step(greatest);
    let step = scene
        .time
        .adaptive
        .as_ref()
        .map_or(scene.time.step, |limits| limits.constant.0);
    format!(
        "viscosity is found implicitly, by a loop in each step (fluid.max_viscosity_error): explicitly it would allow steps of \
         {} s at most, and all else allows {} s",
        number(explicit),
        number(step)
    )
}
