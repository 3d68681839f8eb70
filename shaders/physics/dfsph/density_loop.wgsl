// The loop that keeps densities from exceeding rest density at the end of the step (Bender and Koschier 2015, Algorithm 3).
// It changes where particles go in this step and not their velocities: what corrects errors of density must not become
// motion (Cornelis et al. 2019).
#flag moves
#import physics/dfsph/solve

// How particles go in this step, m/s; their positions after `move_fluid`.
var<storage, read> next_position: array<Packed>;
var<storage, read_write> acting_impulse: array<f32>;

fn velocity_of(j: u32) -> Vector {
    return unpack(next_position[j]);
}

@compute @workgroup_size(GROUP_SIZE)
fn predict_density(thread: Thread) {
    let i = item_index(thread);
    if i >= loop_count() || is_boundary(i) {
        return;
    }
    let dt = time_step();
    let deviation = own[i].deviation + dt * compression_rate(i);
    acting_impulse[i] = iterate(i, deviation / dt);
    add_error(thread, deviation);
}
