// Velocities after all forces but pressure, and the pressures that a step begins with (Bender and Koschier 2015,
// Algorithm 1).
#flag moves
#import common/thread
#import physics/time_step
#import physics/fluid/pairs
#import physics/dfsph/loop
#import physics/dfsph/own

var<storage, read_write> next_velocity: array<Packed>; // w: pressure, Pa
var<storage, read_write> acting_impulse: array<f32>; // Pa·s

@compute @workgroup_size(GROUP_SIZE)
fn apply_forces(thread: Thread) {
    let i = item_index(thread);
    if i >= loop_count() || is_wall(i) {
        return;
    }
    let x = unpack(position[i]);
    let v = unpack(velocity[i]);
    var acceleration = first(parameters.gravity);
#if drag
    var drag = Vector(0.0);
    let home = around(i, x);
    for (var k = 0u; k < RANGES; k++) {
        let range = candidate_range(home, k);
        for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
            let j = candidate(slot);
            let s = toward(x, j);
            let weight = -fluid.volume * kernel_slope(length(s));
            let apart = unpack(velocity[j]) - v;
#if slips
            let sticks = !is_wall(j);
#else
            let sticks = true;
#end
#if viscosity
            drag += select(0.0, 2.0 * fluid.viscosity / fluid.density * weight, sticks) * apart;
#end
#if artificial_viscosity
            let approach = min(dot(apart, s), 0.0);
            let damping = select(0.0, fluid.artificial_viscosity * weight, sticks);
            drag += (damping * approach / (dot(s, s) + fluid.smallest_square)) * s;
#end
        }
    }
    acceleration += drag;
#end
    let impulse = dfsph.warm_start * time_step() * number_of(velocity[i]);
    own[i].impulse = impulse;
    own[i].previous = impulse;
    next_velocity[i] = pack(v + time_step() * acceleration);
    acting_impulse[i] = impulse;
}
