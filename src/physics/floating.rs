//! Rigid bodies in an incompressible fluid: both get from each other what the other loses (Akinci et al. 2012), and bodies answer
//! to pressures within the loop that finds these, as in Gissler et al. 2019.
//!
//! Bodies are made of boundary particles, the first ones by id, in the order of bodies. These have lists, so that forces and
//! torques are summed from the body's side in a fixed order (`shaders/physics/dfsph/bodies/press.wgsl`).

use super::bodies::{shape, state};
use super::dfsph::DIVERGENCE;
use super::layout::{BodyShape, BodyState, Member};
use crate::gpu::{BufferPlan, Items, PassPlan, Variant};
use crate::scene::Scene;
use crate::scene::floating::{are_in, members};
use crate::scene::rigid::RigidBody;

/// Buffers of bodies. `mass` is that of a particle of the fluid, kilograms.
pub(super) fn plan(scene: &Scene, mass: f64, variant: &mut Variant) -> Vec<BufferPlan> {
    if !are_in(scene) {
        return Vec::new();
    }
    let bodies = &scene.rigid_bodies;
    variant
        .constant("RIGID_BODIES", bodies.len() as u32)
        .constant("MEMBERS", members(scene) as u32);
    let shapes: Vec<BodyShape> = bodies
        .iter()
        .map(|body| shape(body, mass, scene.dimensions))
        .collect();
    let states: Vec<BodyState> = bodies.iter().map(|body| state(body, mass)).collect();
    vec![
        BufferPlan::table("member", &table(bodies), "particles of rigid bodies, by id"),
        BufferPlan::table("body_shape", &shapes, "what rigid bodies are made of"),
        BufferPlan::table("body_state", &states, "how rigid bodies move").reported(),
    ]
}

fn table(bodies: &[RigidBody]) -> Vec<Member> {
    let of = |(number, body): (usize, &RigidBody)| {
        let inverse_mass = (1.0 / body.mass) as f32;
        let member = move |place: &glam::DVec3| Member {
            place: place.as_vec3().extend(0.0).into(),
            body: number as u32,
            inverse_mass,
            ..Member::default()
        };
        body.places.iter().map(member).collect::<Vec<_>>()
    };
    bodies.iter().enumerate().flat_map(of).collect()
}

fn pass(file: &str, entry: &str, items: Items, why: &str) -> PassPlan {
    PassPlan::new(&format!("physics/dfsph/bodies/{file}"), entry, items, why)
}

/// Behind the forces on the fluid, before its pressure equation is made.
pub(super) fn begin() -> [PassPlan; 3] {
    let why = "rigid bodies: velocities after weight, viscosity and contacts";
    [
        pass("begin", "begin_bodies", Items::Particles, why),
        pass(
            "show",
            "show_bodies",
            Items::Particles,
            "the same of their particles",
        ),
        look("look_for_bodies", Items::FreeParticles),
    ]
}

fn look(entry: &str, items: Items) -> PassPlan {
    pass(
        "see",
        entry,
        items,
        "how fast rigid bodies press the fluid together",
    )
}

/// Before a sweep over the pressure equation, the first of an iteration or the second.
pub(super) fn answer(second: bool) -> [PassPlan; 2] {
    let why = "rigid bodies answer to the pressures so far (Gissler et al. 2019)";
    let (entry, items) = match second {
        false => ("press_bodies", Items::Loop(DIVERGENCE)),
        true => ("press_bodies_again", Items::LoopSecond(DIVERGENCE)),
    };
    [pass("press", entry, items, why), look("see_bodies", items)]
}

/// Behind what pressures, or then their remainders, do to the fluid.
pub(super) fn push(remainders: bool) -> [PassPlan; 2] {
    let why = "rigid bodies get what the fluid beside them loses";
    let entry = match remainders {
        false => "push_bodies",
        true => "push_bodies_again",
    };
    [
        pass("press", entry, Items::Particles, why),
        look("see_bodies", Items::FreeParticles),
    ]
}

/// At the end of a step.
pub(super) fn go() -> PassPlan {
    let why = "rigid bodies and their particles move (Krysl and Endres 2005)";
    pass("move", "move_bodies", Items::Particles, why)
}

/// Behind each search.
pub(super) fn find() -> [PassPlan; 2] {
    [
        pass(
            "find_members",
            "find_members",
            Items::Particles,
            "where particles of rigid bodies stand",
        ),
        pass(
            "sum_overlaps",
            "sum_overlaps",
            Items::Particles,
            "how far rigid bodies overlap what they touch",
        ),
    ]
}
