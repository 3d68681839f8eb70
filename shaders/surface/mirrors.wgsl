// Sides of the domain as mirrors: beyond them a point sees the particles again, so that the surface meets the side straight.
#import surface/surface

// The side of the domain that is nearer, along each axis.
fn nearer_side(x: vec3f) -> vec3f {
    return select(surface.high.xyz, surface.low.xyz, x - surface.low.xyz < surface.high.xyz - x);
}

// How a point sees the particles in one of the eight images that the sides near it make; the first is no mirror's.
struct Image {
    is_seen: bool,
    at: vec3f, // where the point would be among the particles
    direction: vec3f, // from there back to the point's own axes
}

fn image_of(x: vec3f, number: u32) -> Image {
    let side = nearer_side(x);
    let is_near = abs(x - side) < vec3f(surface.reach);
    let mirrored = (vec3u(number) & vec3u(1u, 2u, 4u)) != vec3u(0u);
    return Image(
        !any(mirrored & !is_near),
        select(x, 2.0 * side - x, mirrored),
        select(vec3f(1.0), vec3f(-1.0), mirrored),
    );
}

// How far a point is beyond the sides of the domain, m; negative inside.
fn beyond_sides(x: vec3f) -> f32 {
    let beyond = max(surface.low.xyz - x, x - surface.high.xyz);
    return max(max(beyond.x, beyond.y), beyond.z);
}
