// The loop that makes velocities free of divergence, by pressures that only push (Bender and Koschier 2015, Algorithm 2).
// Where the fluid is clearly thinner than at rest, it may be pressed together; so a free surface feels no pressure.
#flag moves
#import physics/dfsph/solve

var<storage, read> next_velocity: array<Packed>;
var<storage, read_write> acting_impulse: array<f32>;

fn velocity_of(j: u32) -> Vector {
    return unpack(next_velocity[j]);
}

// Fluid that is thinner by less than this share counts as full: it would fall into every gap of a hundredth and hit its
// neighbors, over and over.
const SLACK: f32 = 0.01;

@compute @workgroup_size(GROUP_SIZE)
fn find_divergence(thread: Thread) {
    let i = item_index(thread);
    if i >= loop_count() || is_boundary(i) {
        return;
    }
    let dt = time_step();
    let rate = compression_rate(i) + min(own[i].deviation + SLACK, 0.0) / dt;
    acting_impulse[i] = iterate(i, rate);
    add_error(thread, rate * dt);
}
