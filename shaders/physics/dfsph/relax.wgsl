// Sweeps over the pressure equation Σ wᵢⱼ (Iⱼ − Iᵢ) / ρ₀ − κᵢ Iᵢ / ρ₀ + source = 0 for impulses I ≥ 0, whose Laplacian is compact
// (Brookshaw 1985; Cummins and Rudman 1999, Eq. 27). Jacobi's sweeps are relaxed, with the momentum of the sweep before,
// which grows (Nesterov 1983): errors that reach far vanish in so many sweeps as they are particles long.
#flag moves
#import common/thread
#import common/parameters
#import physics/time_step
#import physics/fluid/boundary_particles
#import physics/fluid/coefficients
#import physics/dfsph/loop
#import physics/dfsph/own
#import physics/dfsph/pair_list
#import physics/dfsph/errors

var<storage, read> id: array<u32>;
var<storage, read> neighbor_list: array<u32>;
var<storage, read> pair_weight: array<f32>; // 1/m²
var<storage, read_write> impulse: array<f32>; // Pa·s: those before a sweep, and those after it
var<storage, read> convergence: Convergence;

// Impulses stand at `before` + i, and at `after` + i when the sweep is over. Returns what is left of the source, as a share of
// density that a step would gain or lose by it.
fn sweep(i: u32, number: u32, before: u32, after: u32) -> f32 {
    let mine = own[i];
    let present = impulse[before + i];
    var sum = 0.0;
    let first_neighbor = list_row(i);
    let neighbors = neighbor_list[first_neighbor];
    var at = first_neighbor + LIST_HEAD * LIST_LANES;
    var slot = pair_row(i);
    for (var k = 0u; k < neighbors; k++) {
        sum += pair_weight[slot] * impulse[before + neighbor_list[at]];
        slot += LIST_LANES;
        at += LIST_LANES;
    }
    let alone = clamp(mine.response * (mine.source + sum / fluid.density), 0.0, mine.most);
    let momentum = f32(number) / (f32(number) + 3.0);
    let next = present + dfsph.relaxation * (alone - present);
    own[i].previous = next;
    impulse[after + i] = clamp(next + momentum * (next - mine.previous), 0.0, mine.most);
    return select(abs(alone - present) / mine.response * time_step(), 0.0, mine.response == 0.0);
}

@compute @workgroup_size(GROUP_SIZE)
fn relax(thread: Thread) {
    let i = item_index(thread);
    if i < loop_count() && !is_boundary(i) {
        add_error(thread, sweep(i, 2u * convergence.iteration, 0u, loop_count()));
    }
}

@compute @workgroup_size(GROUP_SIZE)
fn relax_again(thread: Thread) {
    let i = item_index(thread);
    if i < loop_count() && !is_boundary(i) {
        sweep(i, 2u * convergence.iteration + 1u, loop_count(), 0u);
    }
}
