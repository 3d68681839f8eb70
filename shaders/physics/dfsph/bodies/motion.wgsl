// How a rigid body moves while a step is made: `half_velocity` and `half_momentum` are what has acted so far, `velocity` and
// `angular_velocity` what the fluid sees.
#import common/vector
#import physics/bodies/body
#import physics/dfsph/bodies/member
#import physics/dfsph/bodies/load

var<storage, read> body_shape: array<BodyShape>;
var<storage, read_write> body_state: array<BodyState>;

// The body after an impulse besides; 2D shapes turn about z alone.
fn pushed(shape: BodyShape, before: BodyState, load: Load) -> BodyState {
    var body = before;
    body.velocity = vec4f(before.half_velocity.xyz + shape.inverse_mass * load.force, 0.0);
    let momentum = before.half_momentum.xyz + load.torque;
    body.angular_velocity = vec4f(angular_velocity_of(shape, before.orientation, momentum), 0.0);
    return body;
}

// The same, for good.
fn pushed_for_good(shape: BodyShape, before: BodyState, load: Load) -> BodyState {
    var body = pushed(shape, before, load);
    body.half_velocity = vec4f(body.velocity.xyz, before.half_velocity.w);
    body.half_momentum = vec4f(before.half_momentum.xyz + load.torque, 0.0);
    return body;
}

// m/s, of a place in a body.
fn velocity_at(body: BodyState, place: vec3f) -> Vector {
    return first(vec4f(body.velocity.xyz + cross(body.angular_velocity.xyz, turned(body.orientation, place)), 0.0));
}
