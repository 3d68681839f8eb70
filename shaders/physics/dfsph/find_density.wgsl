// What a particle's surroundings do: density by summation, the drag of its neighbors, and the rows of the pressure equation
// (relax.wgsl).
#flag writes_state
#import common/thread
#import physics/fluid/pairs
#import physics/fluid/apart
#import physics/fluid/state
#import physics/dfsph/loop
#import physics/dfsph/own
#import physics/dfsph/pair_list
#import fields/solved_pressure
#if boundary_particles
#import physics/dfsph/walls
#end
#if drag
#import physics/dfsph/drag
#end

var<storage, read_write> pair_list: array<Pair>;
var<storage, read_write> pair_weight: array<f32>; // 1/m²

#if boundary_particles
var<storage, read_write> walls: array<Walls>;
#end

// Below this diagonal, in units of 1/spacing², a particle is alone, and pressure has nothing to act on.
const LONELY: f32 = 1e-4;

// Of a particle with this diagonal, 1/m².
fn response(diagonal: f32) -> f32 {
    return select(fluid.density / diagonal, 0.0, diagonal * fluid.spacing * fluid.spacing < LONELY);
}

@compute @workgroup_size(GROUP_SIZE)
fn find_density(thread: Thread) {
    let i = item_index(thread);
    if i >= loop_count() || is_boundary(i) {
        return;
    }
    let x = unpack(position[i]);
    var sum = kernel(0.0);
    var slopes = Vector(0.0); // 1/m
#if drag
    let v = unpack(velocity[i]);
    var drag = Vector(0.0); // m/s²
#end
    var squares = 0.0; // of those that pressure can move, 1/m²
    var weights = 0.0; // of those that have a pressure of their own, 1/m²
#if boundary_particles
    var pull = Vector(0.0);
    var approach = 0.0;
    var lift = Vector(0.0);
#end
    let home = around(i, x);
    for (var k = 0u; k < RANGES; k++) {
        let range = candidate_range(home, k);
        for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
            let j = candidate(slot);
            let s = apart(toward(x, j), i, j);
            let r = length(s);
            sum += kernel(r);
            let steepness = dfsph.slope_volume * kernel_slope(r);
            let slope = steepness * s;
            slopes += slope;
#if drag
            drag += drag_by(j, v, s, steepness);
#end
#if boundary_particles
            if k == 1u {
                pull += slope;
                lift += dot(first(parameters.gravity), s) * slope;
                approach += dot(unpack(velocity[j]), slope);
                continue;
            }
#end
            squares += dot(slope, slope);
            let pair = pair_row(i) + slot - range.x;
            pair_list[pair] = pack_pair(j, slope / dfsph.steepest);
            pair_weight[pair] = -2.0 * steepness;
            weights -= 2.0 * steepness;
        }
    }
    let deviation = fluid.volume * sum - 1.0;
    // At a surface the mirror image of the particle has its pressure reversed, so that pressure is zero halfway.
    let exposed = smoothstep(0.4, 0.8, length(slopes) / dfsph.surface_slope)
        * smoothstep(0.25, 0.75, -deviation / dfsph.surface_density);
    let diagonal = weights + exposed * 2.0 * dfsph.surface_weight;
    let pressure = solved_pressure_of(i);
#if boundary_particles
    walls[i] = Walls(pack_with(pull, approach), pack(lift));
#end
#if boundary_particles
    let uneven = length(slopes + (MIRRORED - 1.0) * pull);
#else
    let uneven = length(slopes);
#end
    let lacking = exposed * dfsph.surface_density * min(length(slopes) / dfsph.surface_slope, 1.0);
    own[i] = Own(
        deviation / dfsph.lattice_gradient,
        lacking / dfsph.lattice_gradient,
        0.0,
        0.0,
        0.0,
        uneven,
        response(diagonal),
        response(dot(slopes, slopes) + squares),
#if drag
        pack(drag),
#end
    );
    fluid_state[i] = vec2f(deviation, pressure);
}
