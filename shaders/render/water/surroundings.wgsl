// What a ray sees that water reflects: a sky that is bright around the key light, and the floor.

#import render/picture

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
    let t = (picture.floor_height - start.y) / direction.y;
    if direction.y < -1e-6 && t > 0.0 {
        let point = start + t * direction;
        let center = 0.5 * (picture.domain_min.xyz + picture.domain_max.xyz);
        let away = length(point.xz - center.xz);
        let fade = 1.0 - smoothstep(picture.floor_fade_begin, picture.floor_fade_end, away);
        color = mix(color, picture.floor_color.rgb, fade);
    }
#end
    return color;
}
