// What the fluid's pressure does to rigid bodies, and their velocities, which the fluid sees: the reverse of what
// divergence_push.wgsl does to the fluid beside them. In each sweep over the pressure equation bodies answer to the pressures
// that the sweep begins with, so that pressures and bodies agree when they have converged (strong coupling, as Gissler et al.
// 2019 have it); bodies far lighter than the fluid then do not tremble.
#flag moves
#import common/parameters
#import physics/time_step
#import physics/fluid/pairs
#import physics/dfsph/loop
#import physics/dfsph/wall_lift
#import physics/dfsph/bodies/numbers
#import physics/dfsph/bodies/motion

var<storage, read> member: array<Member>;
var<storage, read> impulse: array<f32>; // Pa·s
var<storage, read_write> next_velocity: array<Packed>; // w: pressure, Pa

// What pressures do to the particle of a body at x, N s; impulses stand at `before` + i. Where it is `lifted_too`, pressure goes
// on to grow with depth below the surface of the body.
fn pressed(number: u32, mine: u32, before: u32, lifted_too: bool) -> Vector {
    let x = unpack(position[mine]);
    var push = Vector(0.0);
    let range = candidate_range(list_of_member(number, mine), 0u);
    for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
        let j = candidate(slot);
        let s = toward(x, j);
        var acting = MIRRORED * impulse[before + j];
        if lifted_too {
            let share = lifted(number_of(next_velocity[j]));
            acting -= time_step() * fluid.density * share * dot(first(parameters.gravity), s);
        }
        push += (acting * dfsph.slope_volume * kernel_slope(length(s))) * s;
    }
    return fluid.volume * push;
}

fn press(thread: Thread, before: u32, lifted_too: bool, for_good: bool) {
    let step = thread.groups.x * thread.groups.y;
    for (var b = group_index(thread); b < RIGID_BODIES; b += step) {
        let shape = body_shape[b];
        let state = body_state[b];
        var own = Load();
        for (var k = thread.local_index; k < shape.count; k += GROUP_SIZE) {
            let mine = member[shape.first + k];
            let force = to_3d(pressed(shape.first + k, mine.slot, before, lifted_too));
            own.force += force;
            own.torque += cross(turned(state.orientation, mine.place.xyz), force);
        }
        let load = sum_loads(thread, own);
        var body = pushed(shape, state, load);
        if for_good {
            body = pushed_for_good(shape, state, load);
        }
        if thread.local_index == 0u {
            body_state[b] = body;
        }
        for (var k = thread.local_index; k < shape.count; k += GROUP_SIZE) {
            let mine = member[shape.first + k];
            next_velocity[mine.slot] = pack(velocity_at(body, mine.place.xyz));
        }
    }
}

@compute @workgroup_size(GROUP_SIZE)
fn press_bodies(thread: Thread) {
    press(thread, 0u, false, false);
}

@compute @workgroup_size(GROUP_SIZE)
fn press_bodies_again(thread: Thread) {
    press(thread, loop_count(), false, false);
}

// The loop is over.
@compute @workgroup_size(GROUP_SIZE)
fn push_bodies(thread: Thread) {
    press(thread, 0u, true, true);
}

@compute @workgroup_size(GROUP_SIZE)
fn push_bodies_again(thread: Thread) {
    press(thread, 0u, false, true);
}
