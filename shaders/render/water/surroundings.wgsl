// What a ray sees that water reflects: a sky that is bright around the key light, and the floor.

#import render/picture
#if has_floor
#import render/floor
#end

fn sky(direction: vec3f) -> vec3f {
    let up = smoothstep(0.0, 0.75, direction.y);
    // Darker than the backdrop, so that outlines stand out from it.
    let horizon = picture.backdrop_low.rgb * vec3f(0.55, 0.64, 0.72);
    let base = mix(horizon, picture.backdrop_high.rgb * vec3f(0.50, 0.60, 0.75), up);
    let toward = dot(direction, picture.light.xyz);
    return base + 1.2 * exp(14.0 * (toward - 1.0));
}

fn surroundings(start: vec3f, direction: vec3f) -> vec3f {
    var color = sky(vec3f(direction.x, abs(direction.y), direction.z));
#if has_floor
    color = mix(color, picture.floor_color.rgb, floor_seen(start, direction).fade);
#end
    return color;
}
