// How much of a particle's neighborhood is there, and on which side.

struct Surroundings {
    inside: Vector, // away from the surface, 1/m
    surrounded: f32, // divergence of positions: DIMENSIONS inside (Lee 2008)
}

fn surroundings_pair(own: Own, other: Neighbor, forces: ptr<function, Forces>) {
    forces.surroundings.inside -= other.weight * other.s;
    forces.surroundings.surrounded -= other.weight * dot(other.s, other.s);
}

// From zero at the first share of a neighborhood that is there to one at the second.
fn ramp(ends: vec2f, surroundings: Surroundings) -> f32 {
    let share = surroundings.surrounded / f32(DIMENSIONS);
    return clamp((share - ends.x) / (ends.y - ends.x), 0.0, 1.0);
}
