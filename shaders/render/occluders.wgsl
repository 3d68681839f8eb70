// What each sphere surely hides: a square inside its outline, at the depth of its center, almost a texel narrower so
// that every texel whose middle it covers is covered wholly.

#import render/state
#import render/drawn
#import render/picture
#import render/splat_quad

@vertex
fn place_occluder(@builtin(vertex_index) index: u32, @builtin(instance_index) i: u32) -> @builtin(position) vec4f {
    let center = to_3d(unpack(position[i]));
    let quad = splat_quad(center, drawn_radius(i));
    let distance = select(1.0, dot(center - picture.eye.xyz, picture.forward.xyz), picture.eye.w > 0.5);
    let texel = 2.0 * picture.lens.y * distance / f32(picture.rectangle.w);
    let half = 0.7 * drawn_radius(i) - 0.8 * texel;
    if half <= 0.0 || quad.half == 0.0 || !is_drawn(i) {
        return NOWHERE;
    }
    let at = strip_corner(index) * half;
    return picture.view_projection * vec4f(center + quad.across * at.x + quad.up * at.y, 1.0);
}
