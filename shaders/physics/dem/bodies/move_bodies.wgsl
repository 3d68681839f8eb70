// Forces and torques on rigid bodies, and their motion: velocity Verlet in the form of a leapfrog, as leapfrog.wgsl has it.
//
// Centers go as grains do. Turning keeps angular momentum: L(n+½) = L(n−½) + T(n) dt, and the orientation turns by
// dt ω(n+½), where ω(n+½) is what L(n+½) means in the orientation of half a step later, which two iterations find (explicit
// midpoint Lie algorithm of Krysl and Endres 2005). What others see at n+1 is L(n+½) + T(n) dt/2, of second order too.
#flag moves
#import common/thread
#import common/parameters
#import physics/time_step
#import physics/dem/motion
#import physics/dem/rotation
#import physics/dem/frictional_contact
#import physics/bodies/body

// m/s² and rad/s² by id: forces and torques of contacts over the mass of a grain.
var<storage, read> contact_acceleration: array<Motion>;
// By id: the particle's place in its body, m; beside it, the body's number.
var<storage, read> member: array<vec4f>;
var<storage, read> member_slot: array<u32>;
var<storage, read> body_shape: array<BodyShape>;
var<storage, read_write> body_state: array<BodyState>;

struct Load {
    force: vec3f, // N
    torque: vec3f, // about the center of mass, N·m
}

var<workgroup> loads: array<Load, GROUP_SIZE>;

// What the particles of a body feel, those of one thread: every GROUP_SIZE-th of them.
fn load_of(shape: BodyShape, orientation: vec4f, thread: u32) -> Load {
    var load = Load();
    for (var k = thread; k < shape.count; k += GROUP_SIZE) {
        let id = shape.first + k;
        let felt = contact_acceleration[member_slot[id]];
        let arm = turned(orientation, member[id].xyz);
        load.force += felt.linear.xyz;
        load.torque += cross(arm, felt.linear.xyz) + felt.angular.xyz;
    }
    return Load(shape.grain_mass * load.force, shape.grain_mass * load.torque);
}

fn moved(shape: BodyShape, before: BodyState, load: Load, dt: f32) -> BodyState {
    var body = before;
    let kick = 0.5 * (before.half_velocity.w + dt);
    let a = load.force * shape.inverse_mass + parameters.gravity.xyz
        - contact.global_damping * before.velocity.xyz;
    let half = before.half_velocity.xyz + kick * a;
    let way = dt * half + before.center_rest.xyz;
    // See leapfrog.wgsl: no coordinate is farther, which compilers do not know.
    let center = clamp(before.center.xyz + way, vec3f(-contact.farthest), vec3f(contact.farthest));
    body.center = vec4f(center, before.center.w);
    body.center_rest = vec4f(way - (center - before.center.xyz), 0.0);
    body.velocity = vec4f(half + 0.5 * dt * a, 0.0);
    body.half_velocity = vec4f(half, dt);

    let torque = load.torque - contact.global_damping * before.half_momentum.xyz;
    let momentum = before.half_momentum.xyz + kick * torque;
    let q = before.orientation;
    var rate = angular_velocity_of(shape, q, momentum);
    for (var iteration = 0u; iteration < 2u; iteration++) {
        rate = angular_velocity_of(shape, q + turning(q, 0.5 * dt * rate), momentum);
    }
    let off = 1.0 - dot(q, q);
    // Rounding makes it longer or shorter, little by little.
    let turn = turning(q, dt * rate) + before.orientation_rest + select(0.0, 0.5 * off, abs(off) > 1e-6) * q;
    let orientation = clamp(q + turn, vec4f(-contact.farthest), vec4f(contact.farthest));
    body.orientation = orientation;
    body.orientation_rest = turn - (orientation - q);
    body.half_momentum = vec4f(momentum, 0.0);
    let seen = angular_velocity_of(shape, orientation, momentum + 0.5 * dt * torque);
    body.angular_velocity = vec4f(seen, 0.0);
    return body;
}

// A workgroup for each body, and for more of them where there are fewer workgroups. Sums are a fixed tree over ids, so that
// they do not depend on where particles stand.
@compute @workgroup_size(GROUP_SIZE)
fn move_bodies(thread: Thread) {
    let step = thread.groups.x * thread.groups.y;
    for (var b = group_index(thread); b < RIGID_BODIES; b += step) {
        let shape = body_shape[b];
        let state = body_state[b];
        loads[thread.local_index] = load_of(shape, state.orientation, thread.local_index);
        workgroupBarrier();
        for (var reach = GROUP_SIZE / 2u; reach > 0u; reach /= 2u) {
            if thread.local_index < reach {
                loads[thread.local_index].force += loads[thread.local_index + reach].force;
                loads[thread.local_index].torque += loads[thread.local_index + reach].torque;
            }
            workgroupBarrier();
        }
        if thread.local_index == 0u {
            body_state[b] = moved(shape, state, loads[0], time_step());
        }
        workgroupBarrier();
    }
}
