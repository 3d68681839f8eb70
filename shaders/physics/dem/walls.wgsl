// The domain's walls as contacts with the same law as between grains.
#import common/vector
#if rotation
#import physics/dem/friction
#else
#import physics/dem/law
#end

struct ContactWalls {
    lower: vec4f, // m; far away on sides that are not such walls
    upper: vec4f,
    lower_materials: vec4f, // numbers of the sides' materials
    upper_materials: vec4f,
}

var<uniform> contact_walls: ContactWalls;

#if rotation
// Sides are told apart by where they face: keys from -7 to -1.
fn side_key(outwards: Vector) -> f32 {
    let face = to_3d(outwards);
    return face.x + 2.0 * face.y + 3.0 * face.z - 4.0;
}

fn side_material(outwards: Vector) -> u32 {
    let none = Vector(0.0);
    let lower = dot(max(-outwards, none), first(contact_walls.lower_materials));
    return u32(lower + dot(max(outwards, none), first(contact_walls.upper_materials)));
}

fn with_side(sum: ContactSum, outwards: Vector, overlap: f32, v: Vector) -> ContactSum {
#if sizes
    let arm = LARGEST_RADIUS * sum.size - overlap;
    let touch = Touch(side_key(outwards), outwards, overlap, arm, 0.0, -v, Rotation(), Vector(0.0));
#else
    let arm = 0.5 * contact.diameter - overlap;
    let touch = Touch(side_key(outwards), outwards, overlap, arm, -v, Rotation(), Vector(0.0));
#end
    return with_touch(sum, touch, wall_pairing(sum, side_material(outwards)));
}
#else
// Without a branch: a contact of zero overlap and zero approach adds nothing, and six cheap sides cost less than the
// branches. (Branches here crash the shader compiler of Mesa 22.3's software driver.)
fn with_side(sum: ContactSum, outwards: Vector, overlap: f32, v: Vector) -> ContactSum {
    let approach = select(Vector(0.0), -v, overlap > 0.0);
#if sizes
    let damping = damping_by_mass(contact.wall_damping, mass_share(sum.size));
#else
    let damping = contact.wall_damping;
#end
    return with_contact(sum, outwards, max(overlap, 0.0), approach, damping);
}
#end

fn with_walls(before: ContactSum, x: Vector, v: Vector) -> ContactSum {
#if sizes
    let own = Vector(LARGEST_RADIUS * before.size);
#else
    let own = Vector(0.5 * contact.diameter);
#end
    let below = own - (x - first(contact_walls.lower));
    let above = own - (first(contact_walls.upper) - x);
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
