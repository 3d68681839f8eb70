//! Rigid bodies in an incompressible fluid: both get from each other what the other loses (Akinci et al. 2012), and bodies answer
//! to pressures within the loop that finds these, as in Gissler et al. 2019.
//!
//! Bodies are made of boundary particles, the first ones by id, in the order of bodies. These have lists, so that forces and
//! torques are summed from the body's side in a fixed order (`shaders/physics/dfsph/bodies/press.wgsl`).

use super::bodies::{shape, state};
use super::dfsph::{self, DIVERGENCE};
use super::layout::{BodyShape, BodyState, Member};
use crate::gpu::{BufferPlan, Items, PassPlan, Variant};
use crate::scene::Scene;
use crate::scene::floating::{CONTACT_RATE, are_in, members};
use crate::scene::fluid::Fluid;
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
    let rate = format!("const CONTACT_RATE: f32 = {CONTACT_RATE};\n");
    variant.modules.insert("host/contact_rate".into(), rate);
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
    dfsph::pass(&format!("bodies/{file}"), entry, items, why)
}

/// Passes of a scene that has such bodies; others have none.
fn where_bodies_are<const N: usize>(scene: &Scene, passes: [PassPlan; N]) -> Vec<PassPlan> {
    passes.into_iter().filter(|_| are_in(scene)).collect()
}

fn look(entry: &str, items: Items) -> PassPlan {
    let why = "how fast rigid bodies press the fluid together";
    pass("see", entry, items, why)
}

/// Behind the forces on the fluid, before its pressure equation is made.
pub(super) fn begin(scene: &Scene) -> Vec<PassPlan> {
    let why = "rigid bodies: velocities after weight, viscosity and contacts";
    let begin = pass("begin", "begin_bodies", Items::Particles, why);
    let why = "the same of their particles";
    let show = pass("show", "show_bodies", Items::Particles, why);
    where_bodies_are(
        scene,
        [begin, show, look("look_for_bodies", Items::FreeParticles)],
    )
}

/// Before a sweep over the pressure equation, the first of an iteration or the second.
pub(super) fn answer(scene: &Scene, fluid: &Fluid, second: bool) -> Vec<PassPlan> {
    let why = "rigid bodies answer to the pressures so far (Gissler et al. 2019)";
    let (entry, items) = match second {
        false => ("press_bodies", Items::Loop(DIVERGENCE)),
        true => ("press_bodies_again", Items::LoopSecond(DIVERGENCE)),
    };
    let passes = [pass("press", entry, items, why), look("see_bodies", items)];
    where_bodies_are(
        scene,
        passes.map(|pass| dfsph::repeated(fluid, DIVERGENCE, false, pass)),
    )
}

/// Behind what pressures, or then their remainders, do to the fluid.
pub(super) fn push(scene: &Scene, remainders: bool) -> Vec<PassPlan> {
    let why = "rigid bodies get what the fluid beside them loses";
    let entry = match remainders {
        false => "push_bodies",
        true => "push_bodies_again",
    };
    let push = pass("press", entry, Items::Particles, why);
    where_bodies_are(scene, [push, look("see_bodies", Items::FreeParticles)])
}

/// At the end of a step.
pub(super) fn go(scene: &Scene) -> Vec<PassPlan> {
    let why = "rigid bodies and their particles move (Krysl and Endres 2005)";
    where_bodies_are(scene, [pass("move", "move_bodies", Items::Particles, why)])
}

/// Behind each search.
pub(super) fn find(scene: &Scene) -> Vec<PassPlan> {
    let why = "where particles of rigid bodies stand";
    let find = pass("find_members", "find_members", Items::Particles, why);
    let why = "how far rigid bodies overlap what they touch";
    let sum = pass("sum_overlaps", "sum_overlaps", Items::Particles, why);
    where_bodies_are(scene, [find, sum])
}
