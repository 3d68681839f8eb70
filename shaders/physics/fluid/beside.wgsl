// The state that a boundary particle takes on from the fluid beside it.
#import common/parameters
#import physics/fluid/coefficients
#import physics/fluid/material
#import physics/fluid/state
#import physics/fluid/pair_state
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

// Sets the state of boundary particle i at x, which moves at v.
fn extend(i: u32, x: Vector, v: Vector, beside: Beside) {
    let none = beside.weights <= 0.0;
    let share = select(1.0 / beside.weights, 0.0, none);
    let inside = (beside.pressure - dot(first(parameters.gravity), beside.weight_moment)) * share;
    let p = allowed_pressure(select(inside, fluid.background_pressure, none));
    let e = deviation_at(select(beside.stiffness * share, fluid.stiffness, none), p);
    let state = vec2f(e, p);
    fluid_state[i] = state;
    pair_state[i] = pair_state_of(x, v, state);
#if viscous_velocities
    viscous_velocity[i] = pack(select(2.0 * v - beside.velocity * share, v, none));
#end
}
