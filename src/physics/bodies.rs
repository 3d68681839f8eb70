//! Rigid bodies made of grains (Harada 2007, GPU Gems 3, chapter 29): buffers and passes that sum what their particles feel,
//! turn and move them, and take the particles along. Those in a fluid are in `src/physics/floating.rs`.

use glam::{DMat3, DQuat, DVec3};

use super::layout::{BodyShape, BodyState};
use crate::gpu::{BufferPlan, Items, PassPlan, Variant};
use crate::scene::rigid::RigidBody;
use crate::scene::{Dimensions, Scene};

/// A rigid body at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyMotion {
    /// Center of mass, in the scene's coordinates, metres.
    pub center: DVec3,
    /// From its own axes to the scene's.
    pub orientation: DQuat,
    /// m/s.
    pub velocity: DVec3,
    /// rad/s.
    pub angular_velocity: DVec3,
}

/// Decides about the flag of rigid bodies; their buffers.
pub(super) fn plan(scene: &Scene, grain_mass: f64, variant: &mut Variant) -> Vec<BufferPlan> {
    let bodies = &scene.rigid_bodies;
    variant.flag("rigid_bodies", !bodies.is_empty());
    if bodies.is_empty() {
        return Vec::new();
    }
    let members = members(bodies);
    variant
        .constant("RIGID_BODIES", bodies.len() as u32)
        .constant("MEMBERS", members.len() as u32);
    let shapes: Vec<BodyShape> = bodies
        .iter()
        .map(|body| shape(body, grain_mass, scene.dimensions))
        .collect();
    let states: Vec<BodyState> = bodies.iter().map(|body| state(body, grain_mass)).collect();
    vec![
        BufferPlan::table(
            "member",
            &members,
            "where the particles of rigid bodies are in them, by id",
        ),
        BufferPlan::storage(
            "member_slot",
            members.len() as u64,
            4,
            "where these particles stand, by id",
        ),
        BufferPlan::table("body_shape", &shapes, "what rigid bodies are made of"),
        BufferPlan::table("body_state", &states, "how rigid bodies move").reported(),
    ]
}

/// Behind each search: where the particles of bodies stand by now.
pub(super) fn find_members() -> PassPlan {
    pass(
        "find_members",
        "find_members",
        "where particles of rigid bodies stand",
    )
}

/// Behind the sum of contacts: bodies move.
pub(super) fn move_bodies() -> PassPlan {
    pass(
        "move_bodies",
        "move_bodies",
        "forces and torques on rigid bodies in the order of ids, and their motion (Krysl and Endres 2005)",
    )
}

/// Behind that: their particles follow.
pub(super) fn move_members() -> PassPlan {
    pass(
        "move_members",
        "move_members",
        "particles follow their rigid bodies",
    )
}

fn pass(file: &str, entry: &str, why: &str) -> PassPlan {
    let file = format!("physics/dem/bodies/{file}");
    PassPlan::new(&file, entry, Items::Particles, why)
}

/// Of each id up to the last one in a body: its place, and the number of its body beside it; zeros for loose grains.
fn members(bodies: &[RigidBody]) -> Vec<[f32; 4]> {
    let mut members = Vec::new();
    for (number, body) in (1..).zip(bodies) {
        members.resize(body.first as usize, [0.0; 4]);
        let places = body.places.iter().map(|place| place.as_vec3());
        members.extend(places.map(|place| [place.x, place.y, place.z, number as f32]));
    }
    members
}

pub(super) fn shape(body: &RigidBody, grain_mass: f64, dimensions: Dimensions) -> BodyShape {
    BodyShape {
        first: body.first,
        count: body.places.len() as u32,
        inverse_mass: (1.0 / body.mass) as f32,
        grain_mass: grain_mass as f32,
        inverse_inertia: columns(body.inverse_inertia(dimensions)),
    }
}

/// As it is at the start.
pub(super) fn state(body: &RigidBody, grain_mass: f64) -> BodyState {
    let turn = DMat3::from_quat(body.orientation);
    let momentum = turn * body.inertia * turn.transpose() * body.angular_velocity;
    let center = body.center.as_vec3();
    let ratio = body.mass / grain_mass;
    BodyState {
        center: center.extend(ratio as f32).into(),
        center_rest: beside_nothing(body.center - center.as_dvec3()),
        velocity: beside_nothing(body.velocity),
        half_velocity: beside_nothing(body.velocity),
        angular_velocity: beside_nothing(body.angular_velocity),
        half_momentum: beside_nothing(momentum),
        orientation: body.orientation.as_quat().into(),
        orientation_rest: [0.0; 4],
    }
}

/// What the device holds of the scene's bodies, which move like this; `None` where these are not as many.
pub fn states(scene: &Scene, motions: &[BodyMotion]) -> Option<Vec<BodyState>> {
    let mass = (super::model(&scene.matter).particle_mass)(scene);
    let now = |(body, motion): (&RigidBody, &BodyMotion)| {
        let body = RigidBody {
            center: motion.center - scene.origin,
            orientation: motion.orientation,
            velocity: motion.velocity,
            angular_velocity: motion.angular_velocity,
            ..body.clone()
        };
        state(&body, mass)
    };
    let all = scene.rigid_bodies.iter().zip(motions).map(now).collect();
    (motions.len() == scene.rigid_bodies.len()).then_some(all)
}

fn columns(matrix: DMat3) -> [[f32; 4]; 3] {
    matrix
        .to_cols_array_2d()
        .map(|[x, y, z]| [x as f32, y as f32, z as f32, 0.0])
}

fn beside_nothing(v: DVec3) -> [f32; 4] {
    v.as_vec3().extend(0.0).into()
}

/// How bodies move, from what the device holds of them.
pub fn motions(scene: &Scene, states: &[BodyState]) -> Vec<BodyMotion> {
    let vector = |[x, y, z, _]: [f32; 4]| DVec3::new(x.into(), y.into(), z.into());
    let motion = |state: &BodyState| {
        let orientation = DQuat::from_array(state.orientation.map(f64::from));
        let rest = DQuat::from_array(state.orientation_rest.map(f64::from));
        BodyMotion {
            center: vector(state.center) + vector(state.center_rest) + scene.origin,
            orientation: (orientation + rest).normalize(),
            velocity: vector(state.velocity),
            angular_velocity: vector(state.angular_velocity),
        }
    };
    states.iter().map(motion).collect()
}

/// Momentum (kg·m/s) and angular momentum about the scene's zero (kg·m²/s) of all bodies.
pub fn momenta(scene: &Scene, motions: &[BodyMotion]) -> [DVec3; 2] {
    let mut sums = [DVec3::ZERO; 2];
    for (body, motion) in scene.rigid_bodies.iter().zip(motions) {
        let turn = DMat3::from_quat(motion.orientation);
        let own = turn * body.inertia * turn.transpose() * motion.angular_velocity;
        let linear = body.mass * motion.velocity;
        sums[0] += linear;
        sums[1] += motion.center.cross(linear) + own;
    }
    sums
}

/// Energy of motion and, with this gravity (m/s²), of height above the domain's lower corner, joules.
pub fn energies(scene: &Scene, gravity: DVec3, motions: &[BodyMotion]) -> [f64; 2] {
    let corner = scene.domain.min.as_dvec3() + scene.origin;
    let mut sums = [0.0; 2];
    for (body, motion) in scene.rigid_bodies.iter().zip(motions) {
        let own = motion.orientation.inverse() * motion.angular_velocity;
        sums[0] += 0.5 * body.mass * motion.velocity.length_squared() + 0.5 * own.dot(body.inertia * own);
        sums[1] -= body.mass * gravity.dot(motion.center - corner);
    }
    sums
}
