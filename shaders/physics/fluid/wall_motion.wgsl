// Boundary particles move with the body that they belong to.

// By id, from `fluid.first_wall` on.
var<storage, read> boundary: array<vec4f>; // surface velocity, m/s; w: the body's number, -1 for the domain's sides
#if moving_boundaries
var<storage, read> body_velocity: array<vec4f>; // m/s
#end

fn leave_wall(i: u32, x: Vector) {
    let mine = boundary[id[i] - fluid.first_wall];
    var motion = Vector(0.0);
#if moving_boundaries
    if mine.w >= 0.0 {
        motion = first(body_velocity[u32(mine.w)]);
    }
#end
    leave(i, wrapped(x + parameters.time_step * motion), motion + first(mine));
}
