// How much of the key light reaches a point: the shadow map, filtered.

#import render/picture

const SHADOW_SIDE: f32 = f32(SHADOW_TEXELS);

var shadow_map: texture_depth_2d;
var shadow_sampler: sampler_comparison;

// A point in the shadow map: place in 0 to 1, and depth.
fn shadow_place(point: vec3f) -> vec3f {
    let at = (picture.light_projection * vec4f(point, 1.0)).xyz;
    return vec3f(0.5 + 0.5 * at.x, 0.5 - 0.5 * at.y, at.z);
}

// One tap on a surface. The four samples of a pixel look at four places and the resolve averages them.
fn sunlight(point: vec3f, normal: vec3f, pixel: vec2f) -> f32 {
    let at = shadow_place(point + normal * (1.5 * picture.light.w));
    let cell = vec2f(vec2u(pixel) & vec2u(1u)) - 0.5;
    let turned = vec2f(cell.x + 0.5 * cell.y, cell.y - 0.5 * cell.x) * 1.6 / SHADOW_SIDE;
    return textureSampleCompareLevel(shadow_map, shadow_sampler, at.xy + turned, at.z);
}

// Eight taps on a disc (Vogel 1979), for the floor, which is shaded once a pixel; nothing beyond the map is in shadow.
fn soft_sunlight(point: vec3f) -> f32 {
    let at = shadow_place(point);
    if any(at < vec3f(0.0)) || any(at > vec3f(1.0)) {
        return 1.0;
    }
    var lit = 0.0;
    for (var k = 0u; k < 8u; k += 1u) {
        let angle = 2.399963 * f32(k);
        let reach = sqrt(f32(k) + 0.5) * 1.35 / SHADOW_SIDE;
        let place = at.xy + vec2f(cos(angle), sin(angle)) * reach;
        lit += 0.125 * textureSampleCompareLevel(shadow_map, shadow_sampler, place, at.z);
    }
    return lit;
}
