// Boundary particles move with the body that they belong to.

// By id, from `parameters.first_boundary` on.
var<storage, read> boundary: array<vec4f>; // surface velocity, m/s; w: the body's number, -1 for the domain's sides
#if moving_boundaries
var<uniform> body_velocity: array<vec4f, BODIES>; // m/s
#end

struct WallVelocity {
    motion: Vector, // m/s
    surface: Vector, // besides, m/s
}

fn wall_velocity(i: u32) -> WallVelocity {
    let mine = boundary[id[i] - parameters.first_boundary];
    var motion = Vector(0.0);
#if moving_boundaries
    if mine.w >= 0.0 {
        motion = first(body_velocity[u32(mine.w)]);
    }
#end
    return WallVelocity(motion, first(mine));
}
