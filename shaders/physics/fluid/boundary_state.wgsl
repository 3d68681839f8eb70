// Boundary particles take on the pressure and the velocity of the fluid beside them (Adami 2012, Eq. 22 to 27).
#flag writes_state
#import common/thread
#import physics/fluid/pairs
#import physics/fluid/material
#import physics/fluid/state
#if viscous_velocities
// The velocity that viscous forces see: the fluid's own, and one of boundary particles that makes the fluid stick.
var<storage, read_write> viscous_velocity: array<Packed>;
#end

@compute @workgroup_size(GROUP_SIZE)
fn extend_to_boundary(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    let v = unpack(velocity[i]);
    if !is_boundary(i) {
#if viscous_velocities
        viscous_velocity[i] = pack(v);
#end
        return;
    }
    let x = unpack(position[i]);
    var weights = 0.0;
    var pressure = 0.0;
    var weight_moment = Vector(0.0);
    var stiffness = 0.0;
#if viscous_velocities
    var moving = Vector(0.0);
#end
    let home = around(i, x);
    for (var k = 0u; k < RANGES; k++) {
        let range = candidate_range(home, k);
        for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
            let j = candidate(slot);
            let s = toward(x, j);
            if within(s, fluid.support) && !is_boundary(j) {
                let weight = kernel(length(s));
                let state = fluid_state[j];
                let other = material_of(j);
                weights += weight;
                pressure += weight * state.y;
                weight_moment += (weight * other.density * (1.0 + state.x)) * s;
                stiffness += weight * other.stiffness;
#if viscous_velocities
                moving += weight * unpack(velocity[j]);
#end
            }
        }
    }
    let none = weights <= 0.0;
    let share = select(1.0 / weights, 0.0, none);
    let extended = select((pressure - dot(first(parameters.gravity), weight_moment)) * share, fluid.background_pressure, none);
    let p = allowed_pressure(extended);
    let e = deviation_at(select(stiffness * share, fluid.stiffness, none), p);
    fluid_state[i] = vec2f(e, p);
#if viscous_velocities
    viscous_velocity[i] = pack(select(2.0 * v - moving * share, v, none));
#end
}
