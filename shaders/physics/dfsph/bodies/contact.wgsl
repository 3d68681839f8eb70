// What rigid bodies touch: each other and obstacles, particle by particle, and the domain's sides as planes.
#import physics/fluid/pairs
#import physics/dfsph/bodies/numbers
#import physics/dfsph/bodies/member
#if faces
#import physics/fluid/rim
#end

fn touching(number: u32, slot: u32) -> vec2u {
    return candidate_range(list_of_member(number, slot), 1u);
}

// Whether particle j, which touches a particle of `body`, has a contact with it.
fn has_contact(body: u32, j: u32) -> bool {
    let other = member_number(id[j]);
    if other < MEMBERS {
        return member[other].body != body;
    }
#if faces
    // Sides are planes for bodies.
    let x = unpack(position[j]);
    return all(x >= first(rim.lower)) && all(x <= first(rim.upper));
#else
    return true;
#end
}

// Sides count along each axis, m: positive at the lower one, negative at the upper one.
fn overlap_with_sides(x: Vector) -> Vector {
#if faces
    return max(first(rim.lower) - x, Vector(0.0)) - max(x - first(rim.upper), Vector(0.0));
#else
    return Vector(0.0);
#end
}

fn overlap(s: Vector) -> f32 {
    return max(fluid.spacing - length(s), 0.0);
}
