// The last change of velocities in a step, and the way that particles begin the loop of density with: as their velocities say,
// and what corrected densities in the step before acts again.
#flag moves
#import physics/time_step
#import physics/dfsph/push

// Pa·s: what changed of the remainder; behind that of all particles, what the loop of density begins with.
var<storage, read> impulse: array<f32>;
var<storage, read_write> next_velocity: array<Packed>; // w: pressure, Pa
var<storage, read_write> next_position: array<Packed>; // how the particle goes, m/s; w: the pressure's remainder, Pa

@compute @workgroup_size(GROUP_SIZE)
fn finish_velocity(thread: Thread) {
    let i = item_index(thread);
    if i >= loop_count() || is_boundary(i) {
        return;
    }
    let corrections = loop_count();
    let change = impulse[i];
    let correction = impulse[corrections + i];
    var push = Vector(0.0);
    var apart = Vector(0.0);
    let range = pairs_of(i);
    for (var slot = range.x; slot < range.y; slot += LIST_LANES) {
        let pair = pair_list[slot];
        let j = pair_particle(pair);
        let gradient = pair_gradient(pair);
        push += (change + impulse[j]) * gradient;
        apart += (correction + impulse[corrections + j]) * gradient;
    }
    let before = next_velocity[i];
    let v = unpack(before) + finished(i, push, change, MIRRORED);
    next_velocity[i] = pack_with(v, number_of(before));
    next_position[i] = pack_with(v + finished(i, apart, correction, 1.0), own[i].impulse / time_step());
    own[i].impulse = correction;
    own[i].previous = correction;
}
