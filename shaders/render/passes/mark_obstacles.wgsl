// Which triangle of an obstacle the middle of each pixel sees.

#import render/picture
#import render/splat_quad
#import render/passes/marks

var<storage, read> collider_vertex: array<vec4f>;
var<storage, read> collider_look: array<vec4f>;

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) point: vec3f,
    @location(1) normal: vec4f,
    @location(2) @interpolate(flat) mark: u32,
}

@vertex
fn place_marked_obstacle(@builtin(vertex_index) index: u32) -> Corner {
    let at = collider_vertex[2u * index];
    var corner: Corner;
    corner.point = at.xyz + collider_look[2u * u32(at.w)].xyz;
    corner.clip = picture.view_projection * vec4f(corner.point, 1.0);
    corner.normal = collider_vertex[2u * index + 1u];
    corner.mark = OBSTACLE | (index / 3u);
    return corner;
}

@fragment
fn mark_obstacle(corner: Corner) -> @location(0) u32 {
    if corner.normal.w > 0.5 && dot(corner.normal.xyz, to_eye(corner.point).xyz) < 0.0 {
        discard;
    }
#if has_floor
    if corner.point.y < picture.floor_height {
        discard;
    }
#end
    return corner.mark;
}
