// A particle of water, where the middle of a pixel sees it: the smoothed surface, or a drop.

#import render/water/sphere
#import render/water/normal
#import render/passes/surface

fn seen_particle(i: u32, pixel: vec2u) -> Surface {
    let sphere = on_sphere(to_3d(unpack(position[i])), surface_radius(i), pixel);
    if is_drop(i) {
        return sphere;
    }
    // The mean of the pixel's samples that lie on the nearest surface.
    let n = picture.antialias;
    var nearest = NO_SURFACE;
    for (var k = 0u; k < n * n; k += 1u) {
        nearest = min(nearest, surface_at(vec2i(pixel * n + vec2u(k % n, k / n))));
    }
    if nearest == NO_SURFACE {
        return sphere;
    }
    let ray = ray_through(vec2f(pixel) + 0.5);
    var sum = vec4f(0.0); // normals, distances
    var count = 0.0;
    for (var k = 0u; k < n * n; k += 1u) {
        let place = vec2i(pixel * n + vec2u(k % n, k / n));
        let distance = surface_at(place);
        if distance - nearest < water.retreat {
            let toward = to_eye(point_at(place, distance)).xyz;
            sum += vec4f(surface_normal(place, distance, toward), distance);
            count += 1.0;
        }
    }
    return Surface(ray.start + sum.w / count * ray.direction, normalize(sum.xyz));
}
