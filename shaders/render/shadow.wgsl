// How much of the key light reaches a point: the shadow map, filtered.

#import render/picture

var shadow_map: texture_depth_2d;
var shadow_sampler: sampler_comparison;

fn sunlight(point: vec3f, normal: vec3f, pixel: vec2f) -> f32 {
    let texel = picture.light.w;
    let lifted = point + normal * (1.5 * texel);
    let at = (picture.light_projection * vec4f(lifted, 1.0)).xyz;
    // The four samples of a pixel look at four places; the resolve averages them, so one tap each is enough.
    let cell = vec2f(vec2u(pixel) & vec2u(1u)) - 0.5;
    let turned = vec2f(cell.x + 0.5 * cell.y, cell.y - 0.5 * cell.x) * 1.6 / SHADOW_SIDE;
    let place = vec2f(0.5 + 0.5 * at.x, 0.5 - 0.5 * at.y) + turned;
    return textureSampleCompareLevel(shadow_map, shadow_sampler, place, at.z);
}

const SHADOW_SIDE: f32 = f32(SHADOW_TEXELS);
