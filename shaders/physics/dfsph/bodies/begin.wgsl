// Velocities of rigid bodies after all but pressure: weight, viscosity of the fluid, and contacts.
//
// A contact is a spring with a dashpot and Coulomb's friction. The spring is as hard as steps can follow: it swings by
// CONTACT_RATE radians in a step, and steps are so short that bodies do not sink into each other (scene::floating). A body's
// contacts share its spring by their overlaps.
#flag moves
#import common/parameters
#import physics/time_step
#import physics/dfsph/loop
#import physics/dfsph/bodies/contact
#import host/contact_rate
#import physics/dfsph/bodies/motion
#if drag
#import physics/dfsph/drag
#end

var<storage, read> member: array<Member>;

// Bodies bounce with about 0.3 of their speed.
const DAMPING: f32 = 0.36; // share of the critical one
const FRICTION: f32 = 0.3;
// Share of the sliding speed that friction takes in a step at most.
const GRIP: f32 = 0.15;

// Impulse of a contact that overlaps, N s; n points to this body, whose velocity there is v beyond the other's.
fn contact_impulse(mass: f32, share: f32, overlapping: f32, n: Vector, v: Vector) -> Vector {
    let parting = dot(v, n);
    let spring = CONTACT_RATE * CONTACT_RATE * overlapping / time_step();
    let across = max(spring - 2.0 * DAMPING * CONTACT_RATE * parting, 0.0);
    let sliding = v - parting * n;
    let speed = length(sliding);
    let rubbed = min(FRICTION * across, GRIP * speed);
    return mass * share * (across * n - select(Vector(0.0), rubbed / speed * sliding, speed > 0.0));
}

// What particle `number` gets from what it touches; `arm` leads to it from the center of mass.
fn touched(number: u32, mine: Member, x: Vector, v: Vector, arm: vec3f) -> Load {
    var load = Load();
    let range = touching(number, mine.slot);
    for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
        let j = candidate(slot);
        let s = toward(x, j);
        let overlapping = overlap(s);
        if overlapping <= 0.0 || !has_contact(mine.body, j) {
            continue;
        }
        var inverse_mass = mine.inverse_mass;
        var overlaps = mine.overlaps;
        let other = member_number(id[j]);
        if other < MEMBERS {
            inverse_mass += member[other].inverse_mass;
            overlaps = max(overlaps, member[other].overlaps);
        }
        let n = -s / max(length(s), 1e-6 * fluid.spacing);
        let share = overlapping / overlaps;
        let force = to_3d(contact_impulse(1.0 / inverse_mass, share, overlapping, n, v - unpack(velocity[j])));
        load.force += force;
        load.torque += cross(arm + 0.5 * to_3d(s), force);
    }
    let beyond = overlap_with_sides(x);
    for (var axis = 0u; axis < DIMENSIONS; axis++) {
        let overlapping = abs(beyond[axis]);
        if overlapping > 0.0 {
            var n = Vector(0.0);
            n[axis] = sign(beyond[axis]);
            let share = overlapping / mine.overlaps;
            let force = to_3d(contact_impulse(1.0 / mine.inverse_mass, share, overlapping, n, v));
            load.force += force;
            load.torque += cross(arm - 0.5 * fluid.spacing * to_3d(n), force);
        }
    }
    return load;
}

// What the fluid's viscosity does, N s: what find_density.wgsl did to the fluid, reversed.
fn dragged(number: u32, mine: u32, x: Vector, v: Vector) -> Vector {
    var drag = Vector(0.0);
#if drag
#if !slips
    let range = candidate_range(list_of_member(number, mine), 0u);
    for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
        let j = candidate(slot);
        let s = toward(x, j);
        drag += drag_by(j, v, s, dfsph.slope_volume * kernel_slope(length(s)));
    }
#end
#end
    return time_step() * fluid.density * fluid.volume * drag;
}

fn load_of(shape: BodyShape, orientation: vec4f, thread: u32) -> Load {
    var load = Load();
    for (var k = thread; k < shape.count; k += GROUP_SIZE) {
        let number = shape.first + k;
        let mine = member[number];
        let arm = turned(orientation, mine.place.xyz);
        let x = unpack(position[mine.slot]);
        let v = unpack(velocity[mine.slot]);
        let drag = to_3d(dragged(number, mine.slot, x, v));
        let touch = touched(number, mine, x, v, arm);
        load.force += drag + touch.force;
        load.torque += cross(arm, drag) + touch.torque;
    }
    return load;
}

@compute @workgroup_size(GROUP_SIZE)
fn begin_bodies(thread: Thread) {
    let step = thread.groups.x * thread.groups.y;
    for (var b = group_index(thread); b < RIGID_BODIES; b += step) {
        let shape = body_shape[b];
        let before = body_state[b];
        var load = sum_loads(thread, load_of(shape, before.orientation, thread.local_index));
        load.force += time_step() / shape.inverse_mass * parameters.gravity.xyz;
        let body = pushed_for_good(shape, before, load);
        if thread.local_index == 0u {
            body_state[b] = body;
        }
    }
}
