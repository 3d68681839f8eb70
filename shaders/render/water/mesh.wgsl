// The surface of water as a mesh: its depth, its normals, and how much water it encloses along a ray.

#import render/picture
#import render/water/packed_normal
#import render/water/water

var<storage, read> mesh_position: array<vec4f>;
var<storage, read> mesh_normal: array<vec4f>;
var<storage, read> mesh_triangle: array<u32>;
var scene_depth: texture_depth_2d;

struct MeshCorner {
    @builtin(position) clip: vec4f,
    @location(0) normal: vec3f,
}

@vertex
fn place_water_mesh(@builtin(vertex_index) index: u32) -> MeshCorner {
    let vertex = mesh_triangle[index];
    let clip = picture.view_projection * vec4f(mesh_position[vertex].xyz, 1.0);
    return MeshCorner(clip, mesh_normal[vertex].xyz);
}

@fragment
fn keep_water_normal(corner: MeshCorner) -> @location(0) u32 {
    return pack_normal(normalize(corner.normal));
}

struct ChordEnd {
    @builtin(position) clip: vec4f,
    @location(0) point: vec3f,
}

@vertex
fn place_water_chord(@builtin(vertex_index) index: u32) -> ChordEnd {
    let point = mesh_position[mesh_triangle[index]].xyz;
    return ChordEnd(picture.view_projection * vec4f(point, 1.0), point);
}

// Spacings of water: what lies behind the rays' ends at its fronts less what lies behind those at its backs, as far as the eye
// sees. Distances count from the domain's center, so that half floats hold them.
@fragment
fn add_water_chord(end: ChordEnd, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let size = vec2f(textureDimensions(scene_depth));
    let place = end.clip.xy / vec2f((picture.rectangle.zw + 1u) / 2u);
    let solid = view_depth(textureLoad(scene_depth, vec2u(min(place * size, size - 1.0)), 0));
    let center = 0.5 * (picture.domain_min.xyz + picture.domain_max.xyz);
    let depth = min(dot(end.point - picture.eye.xyz, picture.forward.xyz), solid);
    let slant = 1.0 / dot(-to_eye(end.point).xyz, picture.forward.xyz);
    let along = slant * (depth - dot(center - picture.eye.xyz, picture.forward.xyz)) / water.spacing;
    return vec4f(select(along, -along, is_front), 0.0, 0.0, 0.0);
}
