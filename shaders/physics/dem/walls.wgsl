// The domain's walls as contacts with the same law as between grains.
#import common/vector
#import physics/dem/law

struct ContactWalls {
    lower: vec4f, // m; far away on sides that are not such walls
    upper: vec4f,
}

var<uniform> contact_walls: ContactWalls;

// Without a branch: a contact of zero overlap and zero approach adds nothing, and six cheap sides cost less than the
// branches. (Branches here crash the shader compiler of Mesa 22.3's software driver.)
fn with_side(sum: ContactSum, outwards: Vector, overlap: f32, v: Vector) -> ContactSum {
    let approach = select(Vector(0.0), -v, overlap > 0.0);
    return with_contact(sum, outwards, max(overlap, 0.0), approach, contact.wall_damping);
}

fn with_walls(before: ContactSum, x: Vector, v: Vector) -> ContactSum {
    let radius = Vector(0.5 * contact.diameter);
    let below = radius - (x - first(contact_walls.lower));
    let above = radius - (first(contact_walls.upper) - x);
    var sum = before;
#if two_dimensional
    sum = with_side(sum, vec2f(-1.0, 0.0), below.x, v);
    sum = with_side(sum, vec2f(1.0, 0.0), above.x, v);
    sum = with_side(sum, vec2f(0.0, -1.0), below.y, v);
    sum = with_side(sum, vec2f(0.0, 1.0), above.y, v);
#else
    sum = with_side(sum, vec3f(-1.0, 0.0, 0.0), below.x, v);
    sum = with_side(sum, vec3f(1.0, 0.0, 0.0), above.x, v);
    sum = with_side(sum, vec3f(0.0, -1.0, 0.0), below.y, v);
    sum = with_side(sum, vec3f(0.0, 1.0, 0.0), above.y, v);
    sum = with_side(sum, vec3f(0.0, 0.0, -1.0), below.z, v);
    sum = with_side(sum, vec3f(0.0, 0.0, 1.0), above.z, v);
#end
    return sum;
}
