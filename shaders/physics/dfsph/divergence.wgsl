// What the pressure of a step has to undo.
#flag moves
#import physics/fluid/coefficients
#import physics/dfsph/compression
#import fields/solved_pressure

var<storage, read> next_velocity: array<Packed>; // after all forces but pressure
var<storage, read_write> impulse: array<f32>; // Pa·s

// Gaps that are smaller than about this share of density close slowly: particles that fell into every gap of a hundredth
// would hit their neighbors, over and over.
const SMALL_GAP: f32 = 0.05;
// Share of an excess of density that pressure undoes in a step, as long as the excess is small. It keeps columns of water from
// being pressed together little by little, which the loop of density would have to lift from below, row by row. Velocities
// that undo large excesses, as in an impact, would be seen as motion.
const UNDONE: f32 = 0.5;
const SMALL_EXCESS: f32 = 0.002;
// Share of the spacing that pressure may push a particle in a step only because its neighbors stand unevenly around it.
// Without a bound, the pressure of an impact throws the rows that hit a wall first, and energy comes from nowhere.
const MOST_PUSH: f32 = 0.25;

fn velocity_of(j: u32) -> Vector {
    return unpack(next_velocity[j]);
}

// Where the fluid is thinner than at rest, beyond what a surface lacks, it may be pressed together. The pressures of the step
// before are where the loop begins.
@compute @workgroup_size(GROUP_SIZE)
fn find_divergence(thread: Thread) {
    let i = item_index(thread);
    if i >= loop_count() || is_boundary(i) {
        return;
    }
    let dt = time_step();
    let gap = max(-own[i].deviation - own[i].source, 0.0);
    let closing = gap * gap * gap / (gap * gap + SMALL_GAP * SMALL_GAP) / dt;
    let undone = UNDONE * clamp(own[i].deviation, 0.0, SMALL_EXCESS) / dt;
    let begin = dt * solved_pressure_of(i);
    own[i].closing = closing;
    own[i].source = compression_rate(i, MIRRORED) + undone - closing;
    own[i].most = MOST_PUSH * fluid.density * fluid.spacing / max(2.0 * own[i].most * dt, 1e-30);
    own[i].previous = begin;
    impulse[i] = begin;
}
