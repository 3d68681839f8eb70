// Sweeps over the equation of implicit viscosity, v − ν Δt Σ kᵢⱼ eᵢⱼ eᵢⱼ·(vⱼ − vᵢ) = v* with e along the pair, for all particles at
// once (Weiler et al. 2018). Chebyshev's iteration (Golub and Varga 1961) needs no sums over all particles, ends each error
// alike, whatever its wavelength, and keeps momentum from sweep to sweep; stopped early, it is stable too.
#flag moves
#import physics/dfsph/pairs
#import physics/dfsph/damping
#import physics/dfsph/shear
#import physics/dfsph/errors
#if wall_shear
#import physics/fluid/matrix
#end

var<storage, read> pair_weight: array<f32>; // 1/m²
var<storage, read_write> damped: array<Packed>;
var<storage, read> damping: Damping;

#if wall_shear
fn wall_matrix(i: u32) -> Matrix {
    let x = unpack(damped[section(WALL_COLUMNS) + i]);
    let y = unpack(damped[section(WALL_COLUMNS + 1u) + i]);
#if two_dimensional
    return Matrix(x, y);
#else
    return Matrix(x, y, unpack(damped[section(WALL_COLUMNS + 2u) + i]));
#end
}
#end

// One from the velocities in the section `present` to those in `other`, where those of the sweep before stand. Returns what
// `present` leaves, m/s.
fn sweep(i: u32, weight: f32, present: u32, other: u32) -> Vector {
    let v = unpack(damped[present + i]);
    var drag = Vector(0.0);
    let range = pairs_of(i);
    for (var slot = range.x; slot < range.y; slot += LIST_LANES) {
        let pair = pair_list[slot];
        let slope = dfsph.steepest * gradient_unit() * pair_gradient(pair);
        let apart = unpack(damped[present + pair_particle(pair)]) - v;
        let square = dot(slope, slope);
        let near = pair_weight[slot];
        let along = shear_weight(near, pair_square(near, square)) * dot(slope, apart) / max(square, 1e-30);
        drag += along * slope;
    }
#if wall_shear
    drag += unpack(damped[section(WALL_MOTION) + i]) - wall_matrix(i) * v;
#end
    let left = unpack(damped[section(FORCED) + i]) - v + damping.strength * drag;
    let before = unpack(damped[other + i]);
    damped[other + i] = pack(before + weight * (damping.step * left + (v - before)));
    return left;
}

@compute @workgroup_size(GROUP_SIZE)
fn damp(thread: Thread) {
    let i = item_index(thread);
    if i < loop_count() && !is_boundary(i) {
        let left = sweep(i, damping.weight, section(DAMPED), section(DAMPED_AGAIN));
        add_error(thread, length(left) / dfsph.speed);
    }
}

@compute @workgroup_size(GROUP_SIZE)
fn damp_again(thread: Thread) {
    let i = item_index(thread);
    if i < loop_count() && !is_boundary(i) {
        sweep(i, damping.next_weight, section(DAMPED_AGAIN), section(DAMPED));
    }
}
