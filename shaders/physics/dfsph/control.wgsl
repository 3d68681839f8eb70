// Begins, checks and ends the loops.
#flag moves
#import physics/dfsph/loop
#import host/dispatch

// Arguments of indirect dispatches, for each loop those of its first and of its second pass; in w the groups that fit in one
// dimension.
var<storage, read_write> loop_dispatch: array<vec4u>;
// The same for the passes that check a loop, which cannot be dispatched from what they write.
var<storage, read_write> check_dispatch: array<vec4u>;
var<storage, read> dispatch: array<vec4u>;
var<storage, read_write> error_sum: array<u32>; // in units of error_unit(); zero between two uses
var<storage, read_write> convergence: Convergence;

fn first_pass(which: u32) -> u32 {
    return LOOP_ENTRIES * which;
}

fn second_pass(which: u32) -> u32 {
    return LOOP_ENTRIES * which + 1u;
}

fn begin_loop(which: u32) {
    let runs = dispatch[DISPATCH_MOVING].x != 0u;
    let most = dispatch[DISPATCH_MOVING].w;
    let groups = select(0u, (loop_count() + GROUP_SIZE - 1u) / GROUP_SIZE, runs);
    let all = vec4u(min(groups, most), select(0u, (groups + most - 1u) / most, runs), u32(runs), most);
    loop_dispatch[first_pass(which)] = all;
    loop_dispatch[second_pass(which)] = all;
    convergence.iteration = 0u;
}

fn end(pass_number: u32) {
    loop_dispatch[pass_number] = vec4u(0u, 0u, 0u, loop_dispatch[pass_number].w);
}

fn goes_on(which: u32) -> bool {
    return loop_dispatch[first_pass(which)].x != 0u;
}

// Now and then in a loop's course, lets its checks run or no longer run.
fn watch(which: u32) {
    check_dispatch[which] = vec4u(u32(goes_on(which)), 1u, 1u, 0u);
    if !goes_on(which) {
        end(second_pass(which));
    }
}

// What a check found.
struct Found {
    error: f32, // mean over the particles
    is_last: bool, // the loop ends here
    converged: bool,
    iterations: u32, // that the loop has made then
}

// Looks at the mean of the errors that a first pass found, and ends the loop when it is small. One iteration is made in any
// case; where it was not needed, no second look follows.
fn check(which: u32, error: f32, largest_error: f32, most_iterations: u32) -> Found {
    let done = convergence.iteration;
    convergence.iteration = done + 1u;
    let converged = error <= largest_error;
    if converged {
        end(first_pass(which));
        if done > 0u {
            end(second_pass(which));
        }
    }
    let made = max(done + u32(!converged), 1u);
    return Found(error, converged || done + 1u >= most_iterations, converged, made);
}

// Mean error over all particles.
fn mean_error() -> f32 {
    var sum = 0.0;
    for (var k = 0u; k < ERROR_SUMS; k++) {
        sum += f32(error_sum[k]);
        error_sum[k] = 0u;
    }
    return sum * error_unit() / f32(max(parameters.free_count, 1u));
}

@compute @workgroup_size(1)
fn begin_density_loop() {
    begin_loop(DENSITY_LOOP);
}

@compute @workgroup_size(1)
fn begin_divergence_loop() {
    begin_loop(DIVERGENCE_LOOP);
}

@compute @workgroup_size(1)
fn watch_density_loop() {
    watch(DENSITY_LOOP);
}

@compute @workgroup_size(1)
fn watch_divergence_loop() {
    watch(DIVERGENCE_LOOP);
}

@compute @workgroup_size(1)
fn check_density() {
    if !goes_on(DENSITY_LOOP) {
        return;
    }
    let found = check(DENSITY_LOOP, mean_error(), dfsph.density_error, dfsph.density_iterations);
    if !found.is_last {
        return;
    }
    convergence.steps += 1u;
    convergence.density_iterations += found.iterations;
    convergence.most_density_iterations = max(convergence.most_density_iterations, found.iterations);
    convergence.density_unconverged += u32(!found.converged);
    convergence.density_error = max(convergence.density_error, found.error);
}

@compute @workgroup_size(1)
fn check_divergence() {
    if !goes_on(DIVERGENCE_LOOP) {
        return;
    }
    let found = check(DIVERGENCE_LOOP, mean_error(), dfsph.divergence_error, dfsph.divergence_iterations);
    if !found.is_last {
        return;
    }
    convergence.divergence_iterations += found.iterations;
    convergence.most_divergence_iterations = max(convergence.most_divergence_iterations, found.iterations);
    convergence.divergence_unconverged += u32(!found.converged);
    convergence.divergence_error = max(convergence.divergence_error, found.error);
}
#if implicit_viscosity

// The loop of viscosity goes by Chebyshev's iteration: its sweeps damp all errors alike whose equation's matrix has its
// eigenvalues between 1 and a bound.
#import physics/time_step
#import physics/fluid/coefficients
#import physics/dfsph/damping

var<storage, read_write> damping: Damping;
var<storage, read_write> shear_bound: atomic<u32>;

// Share of an eigenvalue by which numbers are rounded.
const DAMPING_ROUNDING: f32 = 1e-7;

@compute @workgroup_size(1)
fn begin_viscosity_loop() {
    begin_loop(VISCOSITY_LOOP);
    if !goes_on(VISCOSITY_LOOP) {
        return;
    }
    damping.strength = time_step() * fluid.viscosity / fluid.density;
    let largest = 1.0 + damping.strength * bitcast<f32>(atomicExchange(&shear_bound, 0u));
    damping.step = 2.0 / (largest + 1.0);
    damping.radius = (largest - 1.0) / (largest + 1.0);
    damping.weight = 1.0;
    damping.rounding = DAMPING_ROUNDING * largest;
}

@compute @workgroup_size(1)
fn watch_viscosity_loop() {
    watch(VISCOSITY_LOOP);
}

@compute @workgroup_size(1)
fn check_viscosity() {
    if !goes_on(VISCOSITY_LOOP) {
        return;
    }
    let square = damping.radius * damping.radius;
    let first = convergence.iteration == 0u;
    damping.next_weight = select(4.0 / (4.0 - square * damping.weight), 2.0 / (2.0 - square), first);
    damping.weight = 4.0 / (4.0 - square * damping.next_weight);

    let left = mean_error();
    damping.first = select(damping.first, left, first);
    let allowed = max(dfsph.viscosity_error * damping.first, damping.rounding);
    let found = check(VISCOSITY_LOOP, left, allowed, dfsph.viscosity_iterations);
    if !found.is_last {
        return;
    }
    convergence.viscosity_iterations += found.iterations;
    convergence.most_viscosity_iterations = max(convergence.most_viscosity_iterations, found.iterations);
    convergence.viscosity_unconverged += u32(!found.converged);
    let share = found.error / max(damping.first, 1e-30);
    // Where viscosity had nothing to change, all that is left is rounding.
    convergence.viscosity_error = max(convergence.viscosity_error, select(share, 0.0, found.error <= damping.rounding));
}
#end
