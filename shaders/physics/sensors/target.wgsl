// What the probe of a force asks: whether it is this body that pushes.
#import physics/sensors/probe

var<private> sensed: Probe;

// Whether a point beyond the domain's sides belongs to the side that is asked: the one that it is farthest beyond.
fn is_sensed_side(x: Vector) -> bool {
    let below = first(sensed.lower) - x;
    let above = x - first(sensed.upper);
    var side = 0u;
    var farthest = below.x;
    for (var axis = 0u; axis < DIMENSIONS; axis++) {
        if below[axis] > farthest {
            farthest = below[axis];
            side = 2u * axis;
        }
        if above[axis] > farthest {
            farthest = above[axis];
            side = 2u * axis + 1u;
        }
    }
    return sensed.target_body == SIDE_TARGETS + side;
}

// With the particle's force on the body and where the particle is, as a reading.
fn pushed(force: Vector, x: Vector) -> Reading {
    let arm = to_3d(x - first(sensed.direction));
    let push = to_3d(force);
    return Reading(vec4f(push, 0.0), vec4f(cross(arm, push), 0.0));
}
