// What the impulses of the loop of density do to the way that particles go.
#flag moves
#import physics/time_step
#import physics/dfsph/push
#import fields/correction

var<storage, read_write> impulse: array<f32>; // of the last iteration, Pa·s
var<storage, read> next_velocity: array<Packed>;
var<storage, read_write> next_position: array<Packed>; // w: the pressure's remainder, Pa

// Before the loop, particles go as their velocities say, and what corrected density in the step before acts again.
@compute @workgroup_size(GROUP_SIZE)
fn follow_velocity(thread: Thread) {
    let i = item_index(thread);
    if i < loop_count() && !is_boundary(i) {
        next_position[i] = pack_with(unpack(next_velocity[i]), own[i].impulse / time_step());
        let needed = clamp(own[i].deviation / dfsph.density_error, 0.0, 1.0);
        let begin = dfsph.warm_correction * needed * time_step() * correction[i];
        impulse[i] = begin;
        own[i].impulse = begin;
        own[i].previous = begin;
    }
}

@compute @workgroup_size(GROUP_SIZE)
fn push_apart(thread: Thread) {
    let i = item_index(thread);
    if i < loop_count() && !is_boundary(i) {
        let way = next_position[i];
        next_position[i] = pack_with(unpack(way) + push_on(i, 1.0), number_of(way));
    }
}
