// The loop of `dfsph`: how far it has come, and the threads that its passes run. It is recorded as often as it may run; once it
// has converged, the device lets the rest of its passes run on nothing.
#import common/vector
#import common/parameters

// Figures since the last frame; the host takes and clears them.
struct Convergence {
    steps: u32,
    divergence_iterations: u32, // summed over the steps
    most_divergence_iterations: u32, // of one step
    divergence_unconverged: u32, // steps that stopped at the largest number of iterations
    divergence_error: f32, // what the worst step stopped at
    iteration: u32, // of the loop that runs now
}

// What the solver stops at (physics::dfsph).
struct Dfsph {
    divergence_error: f32,
    divergence_iterations: u32, // at most
    relaxation: f32, // of Jacobi's iteration
    steepest: f32, // largest gradient of the kernel times a particle's volume, 1/m
    // Of a particle at a flat surface: what its density lacks, the sum of its gradients, 1/m, and of the missing weights, 1/m².
    surface_density: f32,
    surface_slope: f32,
    surface_weight: f32,
}

var<uniform> dfsph: Dfsph;

// Errors are added as whole numbers of a unit, in so many sums (physics::dfsph), which stay below 2³².
const LARGEST_ERROR: f32 = 3.0;

fn error_unit() -> f32 {
    let groups_per_sum = (loop_count() / GROUP_SIZE) / ERROR_SUMS + 1u;
    return f32(groups_per_sum * GROUP_SIZE) * (LARGEST_ERROR / 4e9);
}

// Particles that the loops run over.
fn loop_count() -> u32 {
#if separated
    return parameters.free_count;
#else
    return parameters.particle_count;
#end
}
