// What the pressure of a step has to undo.
#flag moves
#import physics/time_step
#import physics/fluid/coefficients
#import physics/dfsph/pairs

var<storage, read> velocity: array<Packed>; // w: pressure, Pa
var<storage, read> next_velocity: array<Packed>; // after all forces but pressure
var<storage, read> fluid_state: array<vec2f>; // x: ρ/ρ₀ − 1
var<storage, read_write> impulse: array<f32>; // Pa·s

// Gaps that are smaller than about this share of density close slowly: particles that fell into every gap of a hundredth
// would hit their neighbors, over and over.
const SMALL_GAP: f32 = 0.05;
// Share of too much density that a step undoes at most.
const MOST_UNDONE: f32 = 0.2;
// The same per time, in units of √(g/Δx): what undoes density becomes motion, and short steps must not make it violent.
const UNDONE_RATE: f32 = 0.5;

// dρ/dt over ρ₀ of particle i, 1/s. Beyond a wall stands the mirror image of the fluid before it, so walls count twice.
fn compression_rate(i: u32) -> f32 {
    let v = unpack(next_velocity[i]);
    var rates = Vector(0.0);
    let range = pairs_of(i);
    for (var slot = range.x; slot < range.y; slot += LIST_LANES) {
        let pair = pair_list[slot];
        rates += (unpack(next_velocity[pair_particle(pair)]) - v) * pair_gradient(pair);
    }
    var rate = dfsph.steepest * dot(rates, gradient_unit());
#if boundary_particles
    rate += 2.0 * (number_of(wall_pull[i]) - dot(v, unpack(wall_pull[i])));
#end
    return rate;
}

// A source of compression is what velocities do, what there is of too much density, and less where the fluid is thinner than
// at rest: it may be pressed together there. The pressures of the step before are where the loop begins.
@compute @workgroup_size(GROUP_SIZE)
fn find_divergence(thread: Thread) {
    let i = item_index(thread);
    if i >= loop_count() || is_boundary(i) {
        return;
    }
    let dt = time_step();
    let excess = max(fluid_state[i].x, 0.0);
    let gap = max(-fluid_state[i].x - own[i].source, 0.0);
    let undone = min(MOST_UNDONE / dt, UNDONE_RATE * sqrt(length(first(parameters.gravity)) / fluid.spacing));
    let begin = dt * number_of(velocity[i]);
    own[i].source = compression_rate(i) + undone * excess - gap * gap / (gap + SMALL_GAP) / dt;
    own[i].previous = begin;
    impulse[i] = begin;
}
