// The domain's walls as contacts with the same law as between grains.
#import common/vector
#import physics/dem/law

struct ContactWalls {
    lower: vec4f, // m; far away on sides that are not such walls
    upper: vec4f,
}

var<uniform> contact_walls: ContactWalls;

fn add_walls(sum: ptr<function, ContactSum>, x: Vector, v: Vector) {
    let radius = Vector(0.5 * contact.diameter);
    let below = radius - (x - first(contact_walls.lower));
    let above = radius - (first(contact_walls.upper) - x);
    if all(below <= Vector(0.0)) && all(above <= Vector(0.0)) {
        return;
    }
    for (var axis = 0u; axis < DIMENSIONS; axis++) {
        var normal = Vector(0.0);
        if below[axis] > 0.0 {
            normal[axis] = -1.0;
            add_contact(sum, normal, below[axis], -v, contact.wall_damping);
        }
        if above[axis] > 0.0 {
            normal[axis] = 1.0;
            add_contact(sum, normal, above[axis], -v, contact.wall_damping);
        }
    }
}
