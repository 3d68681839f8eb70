// Which disc the middle of each pixel sees.

#import render/state
#import render/drawn
#import render/picture
#import render/splat_quad

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) offset: vec2f,
    @location(1) @interpolate(flat) mark: u32,
}

@vertex
fn place_marked_disc(@builtin(vertex_index) index: u32, @builtin(instance_index) i: u32) -> Corner {
    var corner: Corner;
    let center = to_3d(unpack(position[i]));
    let quad = splat_quad(center, drawn_radius(i));
    corner.offset = strip_corner(index);
    let point = center + (quad.across * corner.offset.x + quad.up * corner.offset.y) * quad.half;
    corner.clip = picture.view_projection * vec4f(point, 1.0);
    let middle = picture.view_projection * vec4f(center, 1.0);
    corner.clip.z = middle.z / middle.w * corner.clip.w;
    corner.mark = i + 1u;
    if !is_drawn(i) {
        corner.clip = NOWHERE;
    }
    return corner;
}

@fragment
fn mark_disc(corner: Corner) -> @location(0) u32 {
    if dot(corner.offset, corner.offset) > 1.0 {
        discard;
    }
    return corner.mark;
}
