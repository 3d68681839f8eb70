// Forces on walls and obstacles in the step that is being made: what pressures and viscosity do to each
// particle on behalf of one body, reversed. This runs when the step's pressures are known and before particles move, which is
// all in between two samples.
#flag moves
#import physics/time_step
#import physics/fluid/pairs
#import physics/dfsph/loop
#import physics/dfsph/own
#import physics/dfsph/wall_lift
#import physics/fluid/sensed_walls
#import physics/sensors/sweep
#import host/dispatch
#if drag
#import physics/dfsph/drag
#end
#if wall_shear
#import physics/dfsph/damping
#import physics/dfsph/wall_shear
#end

var<storage, read> next_velocity: array<Packed>; // w: pressure, Pa
var<storage, read> dispatch: array<vec4u>;
#if wall_shear
var<storage, read> damped: array<Packed>;
#end

fn force_on(i: u32) -> Vector {
    let x = unpack(position[i]);
    let v = unpack(velocity[i]);
    let pressure = number_of(next_velocity[i]);
    let acting = pressure + own[i].impulse / time_step();
    var force = Vector(0.0); // N, over the particle's volume
    let home = around(i, x);
    for (var k = 0u; k < RANGES; k++) {
        let range = candidate_range(home, k);
        for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
            let j = candidate(slot);
            if !is_sensed(j) {
                continue;
            }
            let s = toward(x, j);
            let slope = dfsph.slope_volume * kernel_slope(length(s));
            let lift = fluid.density * lifted(pressure) * dot(first(parameters.gravity), s);
            force += ((2.0 * acting + lift) * slope) * s;
#if drag
            force += fluid.density * drag_by(j, v, s, slope);
#end
#if wall_shear
            let apart = unpack(velocity[j]) - unpack(damped[section(DAMPED) + i]);
            force += fluid.viscosity * (wall_shear_by(s) * apart);
#end
        }
    }
    return force * fluid.volume;
}

@compute @workgroup_size(GROUP_SIZE)
fn sense_walls(thread: Thread) {
    let share = share_of(thread, FIRST_FORCE_PROBE);
    sensed = probes[min(share.probe, FIRST_POINT_PROBE - 1u)];
    var reading = no_reading(PROBE_FORCE);
    // A step that is left out keeps what the last one found.
    let runs = dispatch[DISPATCH_MOVING].x != 0u;
    for (var i = share.first; i < parameters.particle_count; i += share.step) {
        if runs && !is_boundary(i) {
            reading = add_readings(PROBE_FORCE, reading, pushed(-force_on(i), unpack(position[i])));
        }
    }
    leave_reading(thread, share, select(0u, FIRST_POINT_PROBE, runs), PROBE_FORCE, reading);
}
