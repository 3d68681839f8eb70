// What the impulses of the loop of density do to the way that particles go.
#flag moves
#import physics/time_step
#import physics/dfsph/push

var<storage, read> position: array<Packed>; // w: what corrected density in the step before, as a pressure, Pa
var<storage, read_write> acting_impulse: array<f32>; // Pa·s
var<storage, read> next_velocity: array<Packed>;
var<storage, read_write> next_position: array<Packed>;

// Before the loop, particles go as their velocities say, and what corrected density in the step before acts again.
@compute @workgroup_size(GROUP_SIZE)
fn follow_velocity(thread: Thread) {
    let i = item_index(thread);
    if i < loop_count() && !is_boundary(i) {
        let impulse = dfsph.warm_correction * time_step() * number_of(position[i]);
        next_position[i] = next_velocity[i];
        acting_impulse[i] = impulse;
        own[i].impulse = impulse;
        own[i].previous = impulse;
    }
}

@compute @workgroup_size(GROUP_SIZE)
fn push_apart(thread: Thread) {
    let i = item_index(thread);
    if i < loop_count() && !is_boundary(i) {
        next_position[i] = pack(unpack(next_position[i]) + push_on(i));
    }
}
