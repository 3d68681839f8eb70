// What the middle of a pixel sees: a particle, an obstacle, the floor or nothing.

#import render/state
#import render/picture
#import render/passes/marks
#import render/passes/surface
#import <seen_particle>
#if solid_floor
#import render/floor
#end

var pass_mark: texture_2d<u32>;
#if has_obstacles
var<storage, read> collider_vertex: array<vec4f>;
var<storage, read> collider_look: array<vec4f>;
#end

fn mark_at(pixel: vec2u) -> u32 {
    return textureLoad(pass_mark, pixel, 0).r;
}

// The obstacle that a triangle belongs to.
fn obstacle_of(mark: u32) -> u32 {
#if has_obstacles
    return u32(collider_vertex[6u * (mark & ~OBSTACLE)].w);
#else
    return 0u;
#end
}

#if has_obstacles
fn seen_obstacle(mark: u32, ray: Ray) -> Surface {
    let vertex = 6u * (mark & ~OBSTACLE);
    let offset = collider_look[2u * obstacle_of(mark)].xyz;
    let a = collider_vertex[vertex].xyz + offset;
    let ab = collider_vertex[vertex + 2u].xyz + offset - a;
    let ac = collider_vertex[vertex + 4u].xyz + offset - a;
    let across = cross(ab, ac);
    let t = dot(a - ray.start, across) / dot(ray.direction, across);
    let point = ray.start + t * ray.direction;
    let from_a = point - a;
    let share = vec2f(dot(cross(from_a, ac), across), dot(cross(ab, from_a), across)) / dot(across, across);
    let normal = normalize(
        collider_vertex[vertex + 1u].xyz * (1.0 - share.x - share.y)
            + collider_vertex[vertex + 3u].xyz * share.x + collider_vertex[vertex + 5u].xyz * share.y
    );
    return Surface(point, select(-normal, normal, dot(normal, ray.direction) < 0.0));
}
#end

struct Seen {
    is_something: bool,
    surface: Surface,
}

fn seen_at(pixel: vec2u, mark: u32) -> Seen {
    let ray = ray_through(vec2f(pixel) + 0.5);
#if has_obstacles
    if (mark & OBSTACLE) != 0u {
        return Seen(true, seen_obstacle(mark, ray));
    }
#end
    if mark > 0u {
        return Seen(true, seen_particle(mark - 1u, pixel));
    }
#if solid_floor
    let floor = floor_seen(ray.start, ray.direction);
    if floor.fade > 0.5 {
        return Seen(true, Surface(floor.point, vec3f(0.0, 1.0, 0.0)));
    }
#end
    return Seen();
}
