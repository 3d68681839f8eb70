// The loops of `dfsph`: how far each has come, and the threads that its passes run. A loop is recorded as often as it may
// run; once it has converged, the device lets the rest of its passes run on nothing.
#import common/vector
#import common/parameters

// Figures since the last frame; the host takes and clears them.
struct Convergence {
    steps: u32,
    density_iterations: u32, // summed over the steps
    most_density_iterations: u32, // of one step
    density_unconverged: u32, // steps that stopped at the largest number of iterations
    density_error: f32, // what the worst step stopped at, mean of max(ρ/ρ₀ − 1, 0)
    divergence_iterations: u32,
    most_divergence_iterations: u32,
    divergence_unconverged: u32,
    divergence_error: f32, // the same, of what a step's divergence adds to ρ/ρ₀
    viscosity_iterations: u32,
    most_viscosity_iterations: u32,
    viscosity_unconverged: u32,
    viscosity_error: f32, // share of what viscosity had to change that the worst step left
    iteration: u32, // of the loop that runs now
}

// What the solver stops at (physics::dfsph).
struct Dfsph {
    density_error: f32,
    divergence_error: f32,
    density_iterations: u32, // at most
    divergence_iterations: u32,
    relaxation: f32, // of Jacobi's sweeps in the loop of pressure
    density_relaxation: f32, // of Jacobi's iterations in the loop of density
    momentum: f32, // share of an iteration's step that the next one goes on with there
    warm_correction: f32, // share of what corrected densities in the step before that a step begins with
    slope_volume: f32, // volume of a particle by which sums find gradients on a lattice exactly, m³ or m²
    lattice_gradient: f32, // what they would find of a gradient of 1 by the volume by which they find its density
    // Of a particle at a flat surface: what its density lacks, the sum of its gradients, 1/m, and of the missing weights, 1/m².
    surface_density: f32,
    surface_slope: f32,
    surface_weight: f32,
    steepest: f32, // largest gradient of the kernel times a particle's volume, 1/m
    viscosity_error: f32, // share of what viscosity has to change that may be left
    viscosity_iterations: u32, // at most
    speed: f32, // that errors of viscosity are counted in, m/s
    // Factors of the weights by which viscosity acts along pairs: of the pressure equation's, and of these times (r / spacing)⁴.
    shear: f32,
    far_shear: f32,
}

var<uniform> dfsph: Dfsph;

// How often walls count where the mirror image of the fluid stands beyond them.
const MIRRORED: f32 = 2.0;

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
