// What the impulses of the loop of density do to the way that particles go.
#import common/thread
#import physics/dfsph/push
#import physics/dfsph/own

var<storage, read> next_velocity: array<Packed>;
var<storage, read_write> next_position: array<Packed>;

// Before the loop, particles go as their velocities say.
@compute @workgroup_size(GROUP_SIZE)
fn follow_velocity(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    next_position[i] = next_velocity[i];
    if i < loop_count() && !is_wall(i) {
        own[i].impulse = 0.0;
        own[i].previous = 0.0;
    }
}

@compute @workgroup_size(GROUP_SIZE)
fn push_apart(thread: Thread) {
    let i = item_index(thread);
    if i < loop_count() && !is_wall(i) {
        next_position[i] = pack(unpack(next_position[i]) + push_on(i));
    }
}
