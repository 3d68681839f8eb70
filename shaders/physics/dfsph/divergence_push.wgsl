// What the impulses of the loop of divergence do to velocities.
#flag moves
#import physics/time_step
#import physics/dfsph/push

var<storage, read> acting_impulse: array<f32>; // Pa·s
var<storage, read_write> next_velocity: array<Packed>; // w: pressure, Pa

@compute @workgroup_size(GROUP_SIZE)
fn correct_velocity(thread: Thread) {
    let i = item_index(thread);
    if i < loop_count() && !is_boundary(i) {
        next_velocity[i] = pack_with(unpack(next_velocity[i]) + push_on(i), own[i].impulse / time_step());
    }
}
