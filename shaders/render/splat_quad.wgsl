// The square that just covers a sphere on screen.
//
// It stands across the ray to the sphere's center and circumscribes the circle where the cone of tangent rays cuts
// the plane through the center, so its projection is exact in perspective. With k² = |offset|² the ray through a
// point of the square meets the sphere where 1 - k² ≥ 0, free of cancellation however small the sphere is.

#import render/picture

struct SplatQuad {
    toward: vec3f, // unit vector to the eye
    rho: f32, // radius over distance; 0 in an orthographic view
    across: vec3f,
    up: vec3f,
    half: f32, // half side, metres; 0 when the eye is inside
}

fn splat_quad(center: vec3f, radius: f32) -> SplatQuad {
    var quad: SplatQuad;
    let eye = to_eye(center);
    quad.toward = eye.xyz;
    quad.rho = select(0.0, radius / eye.w, picture.eye.w > 0.5);
    quad.across = normalize(cross(picture.up.xyz, eye.xyz));
    quad.up = cross(eye.xyz, quad.across);
    quad.half = select(0.0, radius * inverseSqrt(max(1.0 - quad.rho * quad.rho, 1e-6)), quad.rho < 0.99);
    return quad;
}

// Normal of the sphere where the ray through a point of its square meets it; `offset` is in half sides, at most 1 long.
fn sphere_normal(offset: vec3f, toward: vec3f, rho: f32) -> vec3f {
    let k2 = dot(offset, offset);
    let stretch2 = 1.0 / (1.0 - rho * rho);
    let s = sqrt(max(1.0 - k2, 0.0));
    let d = 1.0 + rho * rho * stretch2 * k2;
    let along = (rho * stretch2 * k2 + s) / d;
    let across = sqrt(stretch2) * (1.0 - rho * s) / d;
    return toward * along + offset * across;
}

// Corner 0 to 3 of a triangle strip, from -1 to 1.
fn strip_corner(index: u32) -> vec2f {
    return vec2f(f32(index & 1u), f32(index >> 1u)) * 2.0 - 1.0;
}

// A position that nothing is drawn at.
const NOWHERE: vec4f = vec4f(2.0, 2.0, 2.0, 1.0);

// Linear values of a color packed as sRGB bytes (IEC 61966-2-1).
fn unpack_srgb(packed: u32) -> vec3f {
    let c = unpack4x8unorm(packed).rgb;
    return select(pow((c + 0.055) / 1.055, vec3f(2.4)), c / 12.92, c <= vec3f(0.04045));
}
