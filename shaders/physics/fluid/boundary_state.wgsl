// Boundary particles take on the pressure and the velocity of the fluid beside them (Adami 2012, Eq. 22 to 27).
#flag writes_state
#import common/thread
#import physics/fluid/pairs
#import physics/fluid/material
#import physics/fluid/state
#import physics/fluid/numbered
#if viscous_velocities
// The velocity that viscous forces see: the fluid's own, and one of boundary particles that makes the fluid stick.
var<storage, read_write> viscous_velocity: array<Packed>;
#end

// Sums over the fluid around a boundary particle.
struct Beside {
    weights: f32,
    pressure: f32,
    weight_moment: Vector,
    stiffness: f32,
#if viscous_velocities
    velocity: Vector,
#end
}

// Sets the state of boundary particle i.
fn extend(i: u32, beside: Beside) {
    let none = beside.weights <= 0.0;
    let share = select(1.0 / beside.weights, 0.0, none);
    let inside = (beside.pressure - dot(first(parameters.gravity), beside.weight_moment)) * share;
    let p = allowed_pressure(select(inside, fluid.background_pressure, none));
    let e = deviation_at(select(beside.stiffness * share, fluid.stiffness, none), p);
    fluid_state[i] = vec2f(e, p);
#if viscous_velocities
    let v = unpack(velocity[i]);
    viscous_velocity[i] = pack(select(2.0 * v - beside.velocity * share, v, none));
#end
}

@compute @workgroup_size(GROUP_SIZE)
fn extend_to_boundary(thread: Thread) {
    let number = item_index(thread);
    let i = numbered_particle(number);
    if i >= parameters.particle_count {
        return;
    }
    if !is_boundary(i) {
#if viscous_velocities
        viscous_velocity[i] = pack(unpack(velocity[i]));
#end
        return;
    }
    let x = unpack(position[i]);
    var beside = Beside();
    let home = around(number, x);
    for (var k = 0u; k < RANGES; k++) {
        let range = candidate_range(home, k);
        for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
            let j = candidate(slot);
            let s = toward(x, j);
            if within(s, fluid.support) && !is_boundary(j) {
                let weight = kernel(length(s));
                let state = fluid_state[j];
                let other = material_of(j);
                beside.weights += weight;
                beside.pressure += weight * state.y;
                beside.weight_moment += (weight * other.density * (1.0 + state.x)) * s;
                beside.stiffness += weight * other.stiffness;
#if viscous_velocities
                beside.velocity += weight * unpack(velocity[j]);
#end
            }
        }
    }
    extend(i, beside);
}

#if boundary_in_reach
#import storage/lists/reach_word
#if continuity
#import fields/density_deviation/write
#end

// Once a search, boundary particles out of reach: no fluid is beside them.
@compute @workgroup_size(GROUP_SIZE)
fn extend_to_unreached(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count || !is_boundary(i) || is_reached(i) {
        return;
    }
    extend(i, Beside());
#if continuity
    // As a step would leave it.
    density_deviation[i] = fluid_state[i].x;
#end
}
#end
