// How much sunlight comes through the water above a point of the floor, by color.

#import render/picture
#import render/shadow
#import render/water/water

var water_shadow: texture_2d<f32>;

fn light_through_water(point: vec3f) -> vec3f {
    let side = vec2f(textureDimensions(water_shadow));
    let at = shadow_place(point).xy * side - 0.5;
    if any(at < vec2f(0.0)) || any(at >= side - 1.0) {
        return vec3f(1.0);
    }
    let corner = vec2u(at);
    let share = fract(at);
    let low = mix(textureLoad(water_shadow, corner, 0), textureLoad(water_shadow, corner + vec2u(1, 0), 0), share.x);
    let high = mix(textureLoad(water_shadow, corner + vec2u(0, 1), 0), textureLoad(water_shadow, corner + vec2u(1, 1), 0), share.x);
    let thickness = mix(low, high, share.y).r;
    // Its surface sends light elsewhere too.
    let entered = 1.0 - 0.25 * (1.0 - exp(-2.0 * thickness));
    return entered * exp(-water.absorption.rgb * thickness * water.spacing);
}
