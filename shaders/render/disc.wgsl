// Particles as flat discs in the color of their value (Rojas 2013).

#import render/state
#import render/drawn
#import render/picture
#import render/splat_quad

var<storage, read> splat: array<u32>;

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) offset: vec2f,
    @location(1) @interpolate(flat) color: vec3f,
}

@vertex
fn place_disc(@builtin(vertex_index) index: u32, @builtin(instance_index) i: u32) -> Corner {
    var corner: Corner;
    let center = to_3d(unpack(position[i]));
    let quad = splat_quad(center, drawn_radius(i));
    corner.offset = strip_corner(index);
    let point = center + (quad.across * corner.offset.x + quad.up * corner.offset.y) * quad.half;
    corner.clip = picture.view_projection * vec4f(point, 1.0);
    // One depth a disc, its center's: discs never cut each other.
    let middle = picture.view_projection * vec4f(center, 1.0);
    corner.clip.z = middle.z / middle.w * corner.clip.w;
    corner.color = unpack_srgb(splat[i]);
    if !is_drawn(i) {
        corner.clip = NOWHERE;
    }
    return corner;
}

@fragment
fn fill_disc(corner: Corner) -> @location(0) vec4f {
    if dot(corner.offset, corner.offset) > 1.0 {
        discard;
    }
    return vec4f(corner.color, 1.0);
}
