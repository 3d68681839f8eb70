// The ray through a place of the picture.

#import render/picture

struct Ray {
    start: vec3f,
    direction: vec3f, // as long as makes one metre along the view's axis
}

// `pixel` is a place of the scene's rectangle: the middle of the first pixel is 0.5.
fn ray_through(pixel: vec2f) -> Ray {
    let size = vec2f(picture.rectangle.zw);
    let ndc = vec2f(2.0 * pixel.x / size.x - 1.0, 1.0 - 2.0 * pixel.y / size.y) - picture.lens.zw;
    let sideways = picture.right.xyz * (ndc.x * picture.lens.x) + picture.up.xyz * (ndc.y * picture.lens.y);
    if picture.eye.w > 0.5 {
        return Ray(picture.eye.xyz, picture.forward.xyz + sideways);
    }
    return Ray(picture.eye.xyz + sideways, picture.forward.xyz);
}
