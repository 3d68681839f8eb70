// Particles into the shadow map: squares of a disc's area across the light, at the depth of the center.

#import render/state
#import render/drawn
#import render/picture
#import render/splat_quad

struct Caster {
    @builtin(position) clip: vec4f,
    @location(0) offset: vec2f,
}

@vertex
fn cast_splat(@builtin(vertex_index) index: u32, @builtin(instance_index) i: u32) -> Caster {
    var caster: Caster;
    let center = picture.light_projection * vec4f(to_3d(unpack(position[i])), 1.0);
    let texels = drawn_radius(i) / picture.light.w;
    caster.offset = strip_corner(index);
#if round_shadows
    let half = texels;
#else
    let half = texels * 0.886; // √π / 2: the area of the disc
#end
    caster.clip = center + vec4f(caster.offset * half * 2.0 / f32(SHADOW_TEXELS), 0.0, 0.0);
    if !is_drawn(i) {
        caster.clip = NOWHERE;
    }
    return caster;
}

@fragment
fn round_splat(caster: Caster) {
    if dot(caster.offset, caster.offset) > 1.0 {
        discard;
    }
}
