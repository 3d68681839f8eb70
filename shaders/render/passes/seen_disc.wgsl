// A particle drawn as a disc, where the middle of a pixel sees it: at the depth of its center, turned to the eye.

#import render/state
#import render/passes/surface

fn seen_particle(i: u32, pixel: vec2u) -> Surface {
    let center = to_3d(unpack(position[i]));
    let ray = ray_through(vec2f(pixel) + 0.5);
    let distance = dot(center - ray.start, picture.forward.xyz);
    return Surface(ray.start + distance * ray.direction, to_eye(center).xyz);
}
