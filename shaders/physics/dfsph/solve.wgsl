// How fast the fluid is pressed together at the velocities so far, and how much that is in all. The file that imports this
// one has `velocity_of(j)`.
#import common/thread
#import physics/time_step
#import physics/fluid/pairs
#import physics/dfsph/loop
#import physics/dfsph/own

var<storage, read_write> partial_error: array<atomic<u32>>; // of workgroups, in units of 1/ERROR_UNITS

// Adds up the errors of a workgroup. Whole numbers have one sum in whatever order they come, and need no barriers, which are
// what software adapters are slowest at.
fn add_error(thread: Thread, error: f32) {
    if error > 0.0 {
        atomicAdd(&partial_error[group_index(thread)], u32(min(error, LARGEST_ERROR) * ERROR_UNITS));
    }
}

// dρ/dt over ρ₀ of particle i, 1/s.
fn compression_rate(i: u32, x: Vector) -> f32 {
    let v = velocity_of(i);
    var rate = 0.0;
    let home = around(i, x);
    for (var k = 0u; k < RANGES; k++) {
        let range = candidate_range(home, k);
        for (var slot = range.x; slot < range.y; slot++) {
            let j = candidate(slot);
            let s = toward(x, j);
            rate += kernel_slope(length(s)) * dot(velocity_of(j) - v, s);
        }
    }
    return fluid.volume * rate;
}
