// Obstacles as contacts with the same law as between grains.
#import common/vector
#import common/parameters
#if rotation
#import physics/dem/friction
#else
#import physics/dem/law
#end
#if moving_colliders
#if adaptive_step
#import physics/step_control
#else
#import physics/clock
#end
#end

struct Collider {
    kind: u32, // COLLIDER_PLANE, _BOX, _SPHERE, _MESH or _CYLINDER
    field_offset: u32, // mesh: its first value in distance_field
    radius: f32, // sphere and cylinder, m; negative for one that is solid outside
    cell: f32, // mesh: distance of the field's nodes, m
    a: vec4f, // plane: a point; box and mesh: lower corner; sphere: center; cylinder: center of an end (m)
    b: vec4f, // plane: normal; box: upper corner (m); mesh: nodes along x, y, z; cylinder: center of the other end (m)
    offset: vec4f, // where it is now, at the first step of the segment, m
    velocity: vec4f, // m/s
    spin: vec4f, // of its surface about a, rad/s; w: number of its material
}

var<uniform> colliders: array<Collider, COLLIDERS>;
#if mesh_colliders
// Signed distances at the nodes of each mesh's field, m; x runs fastest, then y, then z.
var<storage, read> distance_field: array<f32>;
#end

struct Nearest {
    distance: f32, // to the surface, negative inside, m
    outwards: Vector,
}

fn nearest_on_box(x: Vector, lower: Vector, upper: Vector) -> Nearest {
    let center = 0.5 * (lower + upper);
    let local = x - center;
    let beyond = abs(local) - 0.5 * (upper - lower);
    let side = select(Vector(-1.0), Vector(1.0), local >= Vector(0.0));
    let outside = max(beyond, Vector(0.0));
    let distance = length(outside);
    if distance > 0.0 {
        return Nearest(distance, side * outside / distance);
    }
    // Inside: the nearest face.
    var face = 0u;
    for (var axis = 1u; axis < DIMENSIONS; axis++) {
        if beyond[axis] > beyond[face] {
            face = axis;
        }
    }
    var outwards = Vector(0.0);
    outwards[face] = side[face];
    return Nearest(beyond[face], outwards);
}

fn nearest_on_sphere(x: Vector, center: Vector, radius: f32) -> Nearest {
    let local = x - center;
    let distance = length(local);
    var outwards = Vector(0.0);
    outwards.y = 1.0;
    if distance > 0.0 {
        outwards = local / distance;
    }
    let side = sign(radius);
    return Nearest(side * distance - radius, side * outwards);
}

#if cylinders
// Of one that is solid outside, which has no ends, or of one with flat ends.
fn nearest_on_cylinder(x: vec3f, begin: vec3f, end: vec3f, radius: f32) -> Nearest {
    let way = end - begin;
    let axis = normalize(way);
    let along = dot(x - begin, axis);
    let arm = x - begin - along * axis;
    let distance = length(arm);
    let outwards = arm / max(distance, 1e-30);
    let beside = distance - abs(radius);
    if radius < 0.0 {
        return Nearest(-beside, -outwards);
    }
    let cap = select(-axis, axis, 2.0 * along > length(way));
    let beyond = max(-along, along - length(way));
    if beside <= 0.0 || beyond <= 0.0 {
        if beside > beyond {
            return Nearest(beside, outwards);
        }
        return Nearest(beyond, cap);
    }
    let edge = beside * outwards + beyond * cap;
    return Nearest(length(edge), normalize(edge));
}
#end

#if mesh_colliders
fn field_value(collider: Collider, node: vec3u) -> f32 {
    let size = vec3u(collider.b.xyz);
    return distance_field[collider.field_offset + node.x + size.x * (node.y + size.y * node.z)];
}

// Trilinear interpolation of the field, and its gradient.
fn nearest_on_mesh(x: Vector, collider: Collider) -> Nearest {
    let scaled = (x - collider.a.xyz) / collider.cell;
    let last = collider.b.xyz - 1.0;
    if any(scaled < vec3f(0.0)) || any(scaled >= last) {
        return Nearest(contact.diameter, vec3f(0.0, 1.0, 0.0));
    }
    let node = vec3u(scaled);
    let t = scaled - floor(scaled);
    let x00 = vec2f(field_value(collider, node), field_value(collider, node + vec3u(1u, 0u, 0u)));
    let x10 = vec2f(field_value(collider, node + vec3u(0u, 1u, 0u)), field_value(collider, node + vec3u(1u, 1u, 0u)));
    let x01 = vec2f(field_value(collider, node + vec3u(0u, 0u, 1u)), field_value(collider, node + vec3u(1u, 0u, 1u)));
    let x11 = vec2f(field_value(collider, node + vec3u(0u, 1u, 1u)), field_value(collider, node + vec3u(1u, 1u, 1u)));
    let y0 = mix(x00, x10, t.y);
    let y1 = mix(x01, x11, t.y);
    let z = mix(y0, y1, t.z);
    let slope = vec3f(
        z.y - z.x,
        dot(mix(x10 - x00, x11 - x01, t.z), vec2f(1.0 - t.x, t.x)),
        dot(y1 - y0, vec2f(1.0 - t.x, t.x)),
    );
    let steepness = length(slope);
    if steepness == 0.0 {
        return Nearest(contact.diameter, vec3f(0.0, 1.0, 0.0));
    }
    return Nearest(mix(z.x, z.y, t.x), slope / steepness);
}
#end

fn nearest_on(collider: Collider, x: Vector) -> Nearest {
    switch collider.kind {
        case COLLIDER_PLANE: {
            return Nearest(dot(x - first(collider.a), first(collider.b)), first(collider.b));
        }
        case COLLIDER_BOX: {
            return nearest_on_box(x, first(collider.a), first(collider.b));
        }
#if cylinders
        case COLLIDER_CYLINDER: {
            return nearest_on_cylinder(x, collider.a.xyz, collider.b.xyz, collider.radius);
        }
#end
#if mesh_colliders
        case COLLIDER_MESH: {
            return nearest_on_mesh(x, collider);
        }
#end
        default: {
            return nearest_on_sphere(x, first(collider.a), collider.radius);
        }
    }
}

// Velocity of the surface where it is nearest to x, which is relative to the collider, m/s.
fn surface_velocity(collider: Collider, x: Vector, nearest: Nearest) -> Vector {
#if spinning_colliders
    let arm = to_3d(x - nearest.distance * nearest.outwards) - collider.a.xyz;
    return first(collider.velocity + vec4f(cross(collider.spin.xyz, arm), 0.0));
#else
    return first(collider.velocity);
#end
}

#if rotation
// Keys below those of the domain's sides.
fn collider_key(c: u32) -> f32 {
    return -8.0 - f32(c);
}
#end

fn with_collider(before: ContactSum, c: u32, x: Vector, v: Vector) -> ContactSum {
    let collider = colliders[c];
    var offset = first(collider.offset);
#if moving_colliders
#if adaptive_step
    offset += first(collider.velocity) * segment_time();
#else
    offset += first(collider.velocity) * (f32(clock.step_in_segment) * parameters.time_step);
#end
#end
#if sizes
    let own = LARGEST_RADIUS * before.size;
#else
    let own = 0.5 * contact.diameter;
#end
    let nearest = nearest_on(collider, x - offset);
#if rotation
#if sizes
    if nearest.distance >= own + (contact.reach - contact.diameter) {
#else
    if nearest.distance >= contact.reach - own {
#end
        return before;
    }
    let approach = surface_velocity(collider, x - offset, nearest) - v;
    let overlap = own - nearest.distance;
    let arm = nearest.distance;
#if sizes
    let touch = Touch(collider_key(c), -nearest.outwards, overlap, arm, 0.0, approach, Rotation(), Vector(0.0));
#else
    let touch = Touch(collider_key(c), -nearest.outwards, overlap, arm, approach, Rotation(), Vector(0.0));
#end
    return with_touch(before, touch, wall_pairing(before, u32(collider.spin.w)));
#else
    if nearest.distance >= own {
        return before;
    }
    let approach = surface_velocity(collider, x - offset, nearest) - v;
#if sizes
    let damping = damping_by_mass(contact.wall_damping, mass_share(before.size));
#else
    let damping = contact.wall_damping;
#end
    return with_contact(before, -nearest.outwards, own - nearest.distance, approach, damping);
#end
}

fn with_colliders(before: ContactSum, x: Vector, v: Vector) -> ContactSum {
    var sum = before;
    for (var c = 0u; c < COLLIDERS; c++) {
        sum = with_collider(sum, c, x, v);
    }
    return sum;
}
