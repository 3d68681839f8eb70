// Samples to pixels: a box filter in linear light over the backdrop, then sRGB bytes.

#import common/thread
#import render/picture
#import render/backdrop

var scene_color: texture_2d<f32>;
var<storage, read_write> frame_pixels: array<u32>;

fn to_srgb(linear: vec3f) -> vec3f {
    let c = saturate(linear);
    return select(1.055 * pow(c, vec3f(1.0 / 2.4)) - 0.055, 12.92 * c, c <= vec3f(0.0031308));
}

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
    var color = sum.rgb;
    if sum.a < 0.999 {
        color += (1.0 - sum.a) * backdrop(vec2f(pixel) + 0.5);
    }
    // Half a step of ordered noise where the backdrop shows, against bands in its gradient.
    let bayer = f32((pixel.x ^ pixel.y) & 1u) * 0.5 + f32(pixel.y & 1u) * 0.25 - 0.375;
    let noise = bayer / 255.0 * select(0.0, 1.0, sum.a < 0.5);
    let bytes = pack4x8unorm(vec4f(to_srgb(color) + noise, 1.0));
    let at = picture.rectangle.xy + pixel;
    frame_pixels[at.y * picture.frame_width + at.x] = bytes;
}
