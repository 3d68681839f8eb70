// Obstacles as lit surfaces: triangles that the host made, moved by each collider's present offset. Rigid bodies in a fluid come
// behind all colliders, and move with their own state.

#import render/picture
#import render/splat_quad
#import render/lighting
#if floating_bodies
#import physics/bodies/body
#end

// Two entries a vertex: position and number of the collider; normal and 1 where only the outside is drawn.
var<storage, read> collider_vertex: array<vec4f>;
// Two entries a collider: present offset (w: 1 where it casts a shadow); linear color.
var<storage, read> collider_look: array<vec4f>;

#if floating_bodies
var<storage, read> body_state: array<BodyState>;
#end

// Where a vertex is by now, and its normal.
struct Placed {
    point: vec3f,
    normal: vec3f,
}

fn placed(number: u32, point: vec3f, normal: vec3f) -> Placed {
#if floating_bodies
    let bodies = arrayLength(&body_state);
    let colliders = arrayLength(&collider_look) / 2u - bodies;
    if number >= colliders {
        let body = body_state[min(number - colliders, bodies - 1u)];
        return Placed(body.center.xyz + turned(body.orientation, point), turned(body.orientation, normal));
    }
#end
    return Placed(point + collider_look[2u * number].xyz, normal);
}

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) point: vec3f,
    @location(1) normal: vec4f,
    @location(2) @interpolate(flat) albedo: vec3f,
}

@vertex
fn place_collider(@builtin(vertex_index) index: u32) -> Corner {
    let at = collider_vertex[2u * index];
    let number = u32(at.w);
    let normal = collider_vertex[2u * index + 1u];
    let now = placed(number, at.xyz, normal.xyz);
    var corner: Corner;
    corner.point = now.point;
    corner.clip = picture.view_projection * vec4f(corner.point, 1.0);
    corner.normal = vec4f(now.normal, normal.w);
    corner.albedo = collider_look[2u * number + 1u].rgb;
    return corner;
}

@vertex
fn cast_collider(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let at = collider_vertex[2u * index];
    let number = u32(at.w);
    if collider_look[2u * number].w < 0.5 {
        return NOWHERE;
    }
    return picture.light_projection * vec4f(placed(number, at.xyz, vec3f(0.0)).point, 1.0);
}

@fragment
fn shade_collider(corner: Corner) -> @location(0) vec4f {
    let toward = to_eye(corner.point).xyz;
    var normal = normalize(corner.normal.xyz);
    if dot(normal, toward) < 0.0 {
        if corner.normal.w > 0.5 {
            discard;
        }
        normal = -normal;
    }
#if has_floor
    if corner.point.y < picture.floor_height {
        discard;
    }
#end
#if two_dimensional
    return vec4f(corner.albedo, 1.0);
#else
    return vec4f(shade(corner.albedo, normal, toward, corner.point, 1.0, corner.clip.xy), 1.0);
#end
}
