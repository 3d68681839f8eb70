// Obstacles as lit surfaces: triangles that the host made, moved by each collider's present offset.

#import render/picture
#import render/splat_quad
#import render/lighting

// Two entries a vertex: position and number of the collider; normal and 1 where only the outside is drawn.
var<storage, read> collider_vertex: array<vec4f>;
// Two entries a collider: present offset (w: 1 where it casts a shadow); linear color.
var<storage, read> collider_look: array<vec4f>;

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) point: vec3f,
    @location(1) normal: vec4f,
    @location(2) @interpolate(flat) albedo: vec3f,
}

@vertex
fn place_collider(@builtin(vertex_index) index: u32) -> Corner {
    let at = collider_vertex[2u * index];
    let which = 2u * u32(at.w);
    var corner: Corner;
    corner.point = at.xyz + collider_look[which].xyz;
    corner.clip = picture.view_projection * vec4f(corner.point, 1.0);
    corner.normal = collider_vertex[2u * index + 1u];
    corner.albedo = collider_look[which + 1u].rgb;
    return corner;
}

@vertex
fn cast_collider(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let at = collider_vertex[2u * index];
    let place = collider_look[2u * u32(at.w)];
    if place.w < 0.5 {
        return NOWHERE;
    }
    return picture.light_projection * vec4f(at.xyz + place.xyz, 1.0);
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
