// The scene at a pixel, as linear color multiplied by alpha: the mean of the pixel's samples.

#import render/picture

var scene_color: texture_2d<f32>;

fn scene_pixel(pixel: vec2u) -> vec4f {
    let n = picture.antialias;
    var sum = vec4f(0.0);
    for (var y = 0u; y < n; y += 1u) {
        for (var x = 0u; x < n; x += 1u) {
            sum += textureLoad(scene_color, pixel * n + vec2u(x, y), 0);
        }
    }
    return sum / f32(n * n);
}
