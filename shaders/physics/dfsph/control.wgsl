// Begins, checks and ends the loops. One workgroup each, since a pass cannot be dispatched from the buffer that it writes.
#import physics/dfsph/loop

// LOOP_THREADS of physics::dfsph.
const CHECK_THREADS: u32 = 256u;

// Arguments of indirect dispatches, one per loop; in w the groups that fit in one dimension.
var<storage, read_write> loop_dispatch: array<vec4u>;
var<storage, read> dispatch: array<vec4u>;
var<storage, read_write> partial_error: array<u32>; // of workgroups, in units of 1/ERROR_UNITS; zero between two uses
var<storage, read_write> convergence: Convergence;

var<workgroup> thread_error: array<f32, CHECK_THREADS>;
var<workgroup> goes_on: u32;

// Whether a loop has still something to do; every thread calls it.
fn runs(which: u32, thread: u32) -> bool {
    if thread == 0u {
        goes_on = loop_dispatch[which].x;
    }
    return workgroupUniformLoad(&goes_on) != 0u;
}

fn begin_loop(which: u32, runs: bool) {
    let most = dispatch[which].w;
    let groups = select(0u, (loop_count() + GROUP_SIZE - 1u) / GROUP_SIZE, runs);
    loop_dispatch[which] = vec4u(min(groups, most), select(0u, (groups + most - 1u) / most, runs), u32(runs), most);
    convergence.iteration = 0u;
}

// Mean error over all particles; every thread calls it.
fn mean_error(thread: u32) -> f32 {
    let groups = (loop_count() + GROUP_SIZE - 1u) / GROUP_SIZE;
    var sum = 0.0;
    for (var group = thread; group < groups; group += CHECK_THREADS) {
        sum += f32(partial_error[group]) / ERROR_UNITS;
        partial_error[group] = 0u;
    }
    thread_error[thread] = sum;
    workgroupBarrier();
    for (var reach = CHECK_THREADS / 2u; reach > 0u; reach /= 2u) {
        if thread < reach {
            thread_error[thread] += thread_error[thread + reach];
        }
        workgroupBarrier();
    }
    return thread_error[0] / f32(max(parameters.free_count, 1u));
}

// Of `dispatch` (gpu::Items): whether steps go on.
const DISPATCH_MOVING: u32 = 6u;

@compute @workgroup_size(CHECK_THREADS)
fn begin_density_loop(@builtin(local_invocation_index) thread: u32) {
    if thread == 0u {
        begin_loop(DENSITY_LOOP, dispatch[DISPATCH_MOVING].x != 0u);
    }
}

@compute @workgroup_size(CHECK_THREADS)
fn begin_divergence_loop(@builtin(local_invocation_index) thread: u32) {
    if thread == 0u {
        begin_loop(DIVERGENCE_LOOP, dispatch[DISPATCH_MOVING].x != 0u);
    }
}

@compute @workgroup_size(CHECK_THREADS)
fn check_density(@builtin(local_invocation_index) thread: u32) {
    if !runs(DENSITY_LOOP, thread) {
        return;
    }
    let error = mean_error(thread);
    if thread != 0u {
        return;
    }
    let done = convergence.iteration;
    let last = done + 1u >= dfsph.density_iterations;
    let converged = error <= dfsph.density_error && done >= 1u;
    convergence.iteration = done + 1u;
    if !converged && !last {
        return;
    }
    let made = done + u32(!converged);
    convergence.steps += 1u;
    convergence.density_iterations += made;
    convergence.most_density_iterations = max(convergence.most_density_iterations, made);
    convergence.density_unconverged += u32(!converged);
    convergence.density_error = max(convergence.density_error, error);
    if converged {
        loop_dispatch[DENSITY_LOOP] = vec4u(0u, 0u, 0u, loop_dispatch[DENSITY_LOOP].w);
    }
}

@compute @workgroup_size(CHECK_THREADS)
fn check_divergence(@builtin(local_invocation_index) thread: u32) {
    if !runs(DIVERGENCE_LOOP, thread) {
        return;
    }
    let error = mean_error(thread);
    if thread != 0u {
        return;
    }
    let done = convergence.iteration;
    let last = done + 1u >= dfsph.divergence_iterations;
    let converged = error <= dfsph.divergence_error && done >= 1u;
    convergence.iteration = done + 1u;
    if !converged && !last {
        return;
    }
    let made = done + u32(!converged);
    convergence.divergence_iterations += made;
    convergence.most_divergence_iterations = max(convergence.most_divergence_iterations, made);
    convergence.divergence_unconverged += u32(!converged);
    convergence.divergence_error = max(convergence.divergence_error, error);
    if converged {
        loop_dispatch[DIVERGENCE_LOOP] = vec4u(0u, 0u, 0u, loop_dispatch[DIVERGENCE_LOOP].w);
    }
}
