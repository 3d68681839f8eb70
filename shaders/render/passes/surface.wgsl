// A point that the middle of a pixel sees.

#import render/ray
#import render/splat_quad

struct Surface {
    point: vec3f,
    normal: vec3f, // on the eye's side
}

// The point of a sphere that a pixel's middle sees; at its rim where the ray passes by.
fn on_sphere(center: vec3f, radius: f32, pixel: vec2u) -> Surface {
    let ray = ray_through(vec2f(pixel) + 0.5);
    let quad = splat_quad(center, radius);
    // From the center to where the ray meets the square.
    let from_center = ray.start - center;
    let t = -dot(from_center, quad.toward) / dot(ray.direction, quad.toward);
    var offset = (from_center + t * ray.direction) / max(quad.half, 1e-30);
    offset /= max(length(offset), 1.0);
    let normal = sphere_normal(offset, quad.toward, quad.rho);
    return Surface(center + radius * normal, normal);
}
