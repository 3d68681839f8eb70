// Errors of particles, added up for the checks of a loop.
var<storage, read_write> error_sum: array<atomic<u32>>; // in units of error_unit()

// Adds an error to one of several sums, so that threads seldom wait for each other. Whole numbers have one sum in whatever
// order they come, and need no barriers, which are what software adapters are slowest at.
fn add_error(thread: Thread, error: f32) {
    if error > 0.0 {
        let units = u32(min(error, LARGEST_ERROR) / error_unit() + 0.5);
        atomicAdd(&error_sum[group_index(thread) % ERROR_SUMS], units);
    }
}
