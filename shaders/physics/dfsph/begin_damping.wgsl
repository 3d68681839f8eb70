// Before the loop of viscosity: what walls do in it, and how far its equation's eigenvalues reach. Behind it: its velocities.
#flag moves
#import common/thread
#import physics/fluid/pairs
#import physics/fluid/matrix
#import physics/dfsph/damping
#import physics/dfsph/pair_list
#import physics/dfsph/shear
#if wall_shear
#import physics/dfsph/wall_shear
#end

var<storage, read> pair_list: array<Pair>;
var<storage, read> pair_weight: array<f32>; // 1/m²
var<storage, read_write> damped: array<Packed>;
// Bits of a bound of what the matrix of viscosity multiplies velocities by, 1/m²: numbers that are not negative are ordered as
// their bits are.
var<storage, read_write> shear_bound: atomic<u32>;
var<storage, read_write> next_velocity: array<Packed>;

// Sum of each row's absolute values, of which the largest bounds a matrix.
fn row_sums(m: Matrix) -> Vector {
#if two_dimensional
    return abs(m[0]) + abs(m[1]);
#else
    return abs(m[0]) + abs(m[1]) + abs(m[2]);
#end
}

@compute @workgroup_size(GROUP_SIZE)
fn begin_damping(thread: Thread) {
    let i = item_index(thread);
    if i >= loop_count() || is_boundary(i) {
        return;
    }
    var own = Matrix();
    let row = pair_row(i);
    let end = row + neighbor_list[list_row(i)] * LIST_LANES;
    for (var slot = row; slot < end; slot += LIST_LANES) {
        let slope = dfsph.steepest * gradient_unit() * pair_gradient(pair_list[slot]);
        let square = dot(slope, slope);
        let near = pair_weight[slot];
        own += outer(slope, slope) * (shear_weight(near, pair_square(near, square)) / max(square, 1e-30));
    }
    // A pair's part is at most twice that of each particle by itself.
    var all = 2.0 * own;
#if wall_shear
    var beside = Matrix();
    var motion = Vector(0.0);
    let x = unpack(position[i]);
    let candidates = candidate_range(around(i, x), 1u);
    for (var slot = candidates.x; slot < candidates.y; slot += SLOT_STEP) {
        let j = candidate(slot);
        let part = wall_shear_by(toward(x, j));
        beside += part;
        motion += part * unpack(velocity[j]);
    }
    all += beside;
    damped[section(WALL_MOTION) + i] = pack(motion);
    for (var axis = 0u; axis < DIMENSIONS; axis++) {
        damped[section(WALL_COLUMNS + axis) + i] = pack(beside[axis]);
    }
#end
    let sums = row_sums(all);
    var largest = max(sums.x, sums.y);
#if !two_dimensional
    largest = max(largest, sums.z);
#end
    // Most particles find that another one's is larger already.
    let bits = bitcast<u32>(largest);
    if bits > atomicLoad(&shear_bound) {
        atomicMax(&shear_bound, bits);
    }
}

@compute @workgroup_size(GROUP_SIZE)
fn end_damping(thread: Thread) {
    let i = item_index(thread);
    if i < loop_count() && !is_boundary(i) {
        next_velocity[i] = damped[section(DAMPED) + i];
    }
}
