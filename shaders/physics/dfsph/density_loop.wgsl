// The loop that keeps densities from exceeding rest density at the end of the step (Bender and Koschier 2015, Algorithm 3).
// It changes where particles go in this step and not their velocities: what corrects errors of density must not become
// motion (Cornelis et al. 2019).
#flag moves
#import physics/dfsph/compression
#import physics/dfsph/errors

// How particles go in this step, m/s; their positions after `move_fluid`.
var<storage, read> next_position: array<Packed>;
var<storage, read_write> impulse: array<f32>; // Pa·s, of this iteration

fn velocity_of(j: u32) -> Vector {
    return unpack(next_position[j]);
}

// An iteration is a step of Jacobi's, relaxed, with the momentum of the step before (Nesterov 1983).
@compute @workgroup_size(GROUP_SIZE)
fn predict_density(thread: Thread) {
    let i = item_index(thread);
    if i >= loop_count() || is_boundary(i) {
        return;
    }
    let dt = time_step();
    let mine = own[i];
    let deviation = mine.deviation + dt * compression_rate(i, 1.0);
    let next = max(mine.impulse + dfsph.density_relaxation * deviation / dt * mine.exact_response, 0.0);
    let ahead = next + dfsph.momentum * (next - mine.previous);
    own[i].previous = next;
    own[i].impulse = ahead;
    impulse[i] = ahead - mine.impulse;
    add_error(thread, deviation);
}
