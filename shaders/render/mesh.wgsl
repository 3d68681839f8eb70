// The surface around the particles as a lit solid that mirrors the sky a little, and its shadow.

#import render/picture
#import render/lighting
#import render/splat_quad
#import render/water/surroundings

var<storage, read> mesh_position: array<vec4f>;
var<storage, read> mesh_normal: array<vec4f>;
var<storage, read> mesh_triangle: array<u32>;
var<storage, read> mesh_color: array<u32>; // sRGB bytes

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) point: vec3f,
    @location(1) normal: vec3f,
    @location(2) albedo: vec3f,
}

@vertex
fn place_mesh(@builtin(vertex_index) index: u32) -> Corner {
    let vertex = mesh_triangle[index];
    var corner: Corner;
    corner.point = mesh_position[vertex].xyz;
    corner.clip = picture.view_projection * vec4f(corner.point, 1.0);
    corner.normal = mesh_normal[vertex].xyz;
    corner.albedo = unpack_srgb(mesh_color[vertex]);
    return corner;
}

@vertex
fn cast_mesh(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return picture.light_projection * vec4f(mesh_position[mesh_triangle[index]].xyz, 1.0);
}

// Of a polished surface where one looks straight at it, and at its rim.
const LEAST_MIRRORED: f32 = 0.04;
const MOST_MIRRORED: f32 = 0.2;

@fragment
fn shade_mesh(corner: Corner) -> @location(0) vec4f {
    let toward = to_eye(corner.point).xyz;
    let normal = normalize(corner.normal);
    let lit = shade(corner.albedo, normal, toward, corner.point, 1.0, corner.clip.xy);
    let away = pow(1.0 - saturate(dot(normal, toward)), 5.0);
    let mirrored = surroundings(corner.point, reflect(-toward, normal));
    return vec4f(mix(lit, mirrored, mix(LEAST_MIRRORED, MOST_MIRRORED, away)), 1.0);
}
