// The floor, which fades into the backdrop far from the domain.

#import render/picture

struct Floor {
    point: vec3f,
    fade: f32, // its share of the color there; 0 where a ray meets none
}

fn floor_seen(start: vec3f, direction: vec3f) -> Floor {
    let t = (picture.floor_height - start.y) / direction.y;
    if direction.y >= -1e-6 || t <= 0.0 {
        return Floor();
    }
    let point = start + t * direction;
    let center = 0.5 * (picture.domain_min.xyz + picture.domain_max.xyz);
    let away = length(point.xz - center.xz);
    return Floor(point, 1.0 - smoothstep(picture.floor_fade_begin, picture.floor_fade_end, away));
}
