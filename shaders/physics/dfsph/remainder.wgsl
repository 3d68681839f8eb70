// What the compact equation does not see. Its weights are those of a smooth field; where particles stand without order, its
// pressures leave divergence behind, of the size of single particles and much the same from step to step. Each step adds one
// iteration against it to a remainder, which acts with the pressure. So velocities are free of the divergence by which
// densities change, and neighbors' pressures still cannot come apart.
#flag moves
#import physics/dfsph/compression
#import fields/correction

var<storage, read_write> next_velocity: array<Packed>; // w: pressure, Pa
var<storage, read_write> impulse: array<f32>; // what is to act, Pa·s; behind that of all particles, corrections of density

// Of the iteration.
const RELAXATION: f32 = 0.5;

fn velocity_of(j: u32) -> Vector {
    return unpack(next_velocity[j]);
}

// The loop is over: its pressure is the particle's, and acts with the remainder. They never pull.
@compute @workgroup_size(GROUP_SIZE)
fn add_remainder(thread: Thread) {
    let i = item_index(thread);
    if i < loop_count() && !is_boundary(i) {
        let remainder = max(own[i].impulse, -impulse[i]);
        next_velocity[i] = pack_with(unpack(next_velocity[i]), impulse[i] / time_step());
        own[i].impulse = remainder;
        impulse[i] += remainder;
    }
}

@compute @workgroup_size(GROUP_SIZE)
fn find_remainder(thread: Thread) {
    let i = item_index(thread);
    if i >= loop_count() || is_boundary(i) {
        return;
    }
    let mine = own[i];
    let rate = compression_rate(i, MIRRORED) - mine.closing;
    let pressure = number_of(next_velocity[i]);
    let next = max(mine.impulse + RELAXATION * rate * mine.exact_response, -time_step() * pressure);
    own[i].impulse = next;
    impulse[i] = next - mine.impulse;
    // What corrected density in the step before, as far as density is still too high.
    let needed = clamp(mine.deviation / dfsph.density_error, 0.0, 1.0);
    impulse[loop_count() + i] = dfsph.warm_correction * needed * time_step() * correction[i];
}
