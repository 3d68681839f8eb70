// Samples to pixels: a box filter in linear light over the backdrop, then sRGB bytes.

#import common/thread
#import render/picture
#import render/backdrop
#import render/pixel

var scene_color: texture_2d<f32>;
var<storage, read_write> frame_pixels: array<u32>;

@compute @workgroup_size(GROUP_SIZE)
fn resolve(thread: Thread) {
    let item = item_index(thread);
    let size = picture.rectangle.zw;
    if item >= size.x * size.y {
        return;
    }
    let pixel = vec2u(item % size.x, item / size.x);
    let n = picture.antialias;
    var sum = vec4f(0.0);
    for (var y = 0u; y < n; y += 1u) {
        for (var x = 0u; x < n; x += 1u) {
            sum += textureLoad(scene_color, pixel * n + vec2u(x, y), 0);
        }
    }
    sum /= f32(n * n);
    var color = sum;
    if sum.a < 0.999 {
        color += (1.0 - sum.a) * backdrop(vec2f(pixel) + 0.5);
    }
    // Where the backdrop shows, its gradient would have bands.
    let noise = select(0.0, 1.0, sum.a < 0.5);
    let at = picture.rectangle.xy + pixel;
    frame_pixels[at.y * picture.frame_width + at.x] = finished(color, pixel, noise);
}
