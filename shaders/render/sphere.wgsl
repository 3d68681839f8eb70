// Particles as lit spheres with true depth; the vertex stage pulls them by instance (Rojas 2013, with four corners in
// the geometry shader's place).

#import render/state
#import render/drawn
#import render/picture
#import render/splat_quad
#if matte
#import <own_surface>
#else
#import render/lighting
#end

var<storage, read> splat: array<u32>;

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) offset: vec3f, // on the square, in units of its half side
    @location(1) @interpolate(flat) toward: vec3f,
    @location(2) @interpolate(flat) center: vec3f,
    @location(3) @interpolate(flat) albedo: vec3f,
    @location(4) @interpolate(flat) rho_openness: vec2f,
#if sizes
    @location(5) @interpolate(flat) radius: f32,
#end
#if matte
    @location(6) @interpolate(flat) turn: vec4f,
    @location(7) @interpolate(flat) detail: f32,
#end
}

@vertex
fn place_sphere(@builtin(vertex_index) index: u32, @builtin(instance_index) i: u32) -> Corner {
    var corner: Corner;
    corner.clip = NOWHERE;
    let look = splat[i];
    if look >= 0x1000000u && is_drawn(i) { // otherwise hidden
        let center = to_3d(unpack(position[i]));
        let quad = splat_quad(center, drawn_radius(i));
        let at = strip_corner(index);
        corner.offset = quad.across * at.x + quad.up * at.y;
        corner.clip = picture.view_projection * vec4f(center + corner.offset * quad.half, 1.0);
        corner.toward = quad.toward;
        corner.center = center;
#if sizes
        corner.radius = drawn_radius(i);
#end
#if matte
        let grain = grain_of(id[i], drawn_radius(i), to_eye(center).w);
        corner.turn = grain.turn;
        corner.detail = grain.detail;
#end
        corner.albedo = unpack_srgb(look);
        corner.rho_openness = vec2f(quad.rho, f32(look >> 24u) / 255.0);
    }
    return corner;
}

struct Surface {
    @location(0) color: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn shade_sphere(corner: Corner) -> Surface {
    let k2 = dot(corner.offset, corner.offset);
    if k2 > 1.0 {
        discard;
    }
    let normal = sphere_normal(corner.offset, corner.toward, corner.rho_openness.x);
#if sizes
    let radius = corner.radius;
#else
    let radius = picture.radius;
#end
    let point = corner.center + radius * normal;
    let clip = picture.view_projection * vec4f(point, 1.0);
    var surface: Surface;
    surface.depth = clip.z / clip.w;
    let openness = corner.rho_openness.y;
#if matte
    let seen = own_surface(Grain(corner.turn, corner.detail), corner.albedo, normal);
    surface.color = vec4f(shade_matte(seen, normal, corner.toward, point, openness, corner.clip.xy), 1.0);
#else
    surface.color = vec4f(shade(corner.albedo, normal, corner.toward, point, openness, corner.clip.xy), 1.0);
#end
    return surface;
}
