// How fast the fluid is pressed together at the velocities so far, and how much that is in all. The file that imports this
// one has `velocity_of(j)`.
#import physics/time_step
#import physics/dfsph/pairs

var<storage, read_write> error_sum: array<atomic<u32>>; // in units of error_unit()

// Adds an error to one of several sums, so that threads seldom wait for each other. Whole numbers have one sum in whatever
// order they come, and need no barriers, which are what software adapters are slowest at.
fn add_error(thread: Thread, error: f32) {
    if error > 0.0 {
        let units = u32(min(error, LARGEST_ERROR) / error_unit() + 0.5);
        atomicAdd(&error_sum[group_index(thread) % ERROR_SUMS], units);
    }
}

// dρ/dt over ρ₀ of particle i, 1/s.
fn compression_rate(i: u32) -> f32 {
    let v = velocity_of(i);
    var rates = Vector(0.0);
    let range = pairs_of(i);
    for (var slot = range.x; slot < range.y; slot += LIST_LANES) {
        let pair = pair_list[slot];
        rates += (velocity_of(pair_particle(pair)) - v) * pair_gradient(pair);
    }
    var rate = dfsph.steepest * dot(rates, gradient_unit());
#if boundary_particles
    rate += number_of(wall_pull[i]) - dot(v, unpack(wall_pull[i]));
#end
    return rate;
}
