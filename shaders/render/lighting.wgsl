// A key light with shadows, a sky above and a floor below, a little light from the eye, a soft shoulder.

#import render/picture
#if shadows
#import render/shadow
#end

// `openness` is the share of the surroundings' light that reaches the place; `pixel` turns the shadow's filter.
fn shade(albedo: vec3f, normal: vec3f, toward_eye: vec3f, point: vec3f, openness: f32, pixel: vec2f) -> vec3f {
    let toward_light = picture.light.xyz;
    let lit = sunlit(point, normal, pixel);
    let key = max(dot(normal, toward_light), 0.0) * lit;
    let sky = sky_light(normal);
    let facing = max(dot(normal, toward_eye), 0.0);
    // Rims of packed grains lie in crevices.
    let crevice = 0.55 + 0.45 * facing;
    let light = (sky * crevice + 0.12 * facing) * openness + SUN * key;
    let halfway = normalize(toward_light + toward_eye);
    let gloss = 0.10 * pow(max(dot(normal, halfway), 0.0), 40.0) * lit;
    return soften(albedo * light + gloss);
}

// The share of the key light that reaches a place.
fn sunlit(point: vec3f, normal: vec3f, pixel: vec2f) -> f32 {
#if shadows
    return sunlight(point, normal, pixel);
#else
    return 1.0;
#end
}

const SUN: vec3f = vec3f(0.86, 0.84, 0.80);

// What comes from above and below.
fn sky_light(normal: vec3f) -> vec3f {
    return mix(vec3f(0.25, 0.24, 0.23), vec3f(0.46, 0.48, 0.51), normal.y * 0.5 + 0.5);
}

// Linear up to the knee, then towards 1.
fn soften(color: vec3f) -> vec3f {
    let knee = 0.7;
    let above = max(color - knee, vec3f(0.0));
    return min(color, vec3f(knee)) + (1.0 - knee) * above / (above + (1.0 - knee));
}
