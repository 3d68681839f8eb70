// Samples to pixels: a box filter in linear light over the backdrop, then sRGB bytes.

#import common/thread
#import render/picture
#import render/backdrop
#import render/pixel
#import render/scene_pixel

var<storage, read_write> frame_pixels: array<u32>;
#if color_pass
var<storage, read_write> pass_color: array<vec2u>; // half floats, multiplied by alpha
#end

@compute @workgroup_size(GROUP_SIZE)
fn resolve(thread: Thread) {
    let item = item_index(thread);
    let size = picture.rectangle.zw;
    if item >= size.x * size.y {
        return;
    }
    let pixel = vec2u(item % size.x, item / size.x);
    let sum = scene_pixel(pixel);
    var color = sum;
    if sum.a < 0.999 {
        color += (1.0 - sum.a) * backdrop(vec2f(pixel) + 0.5);
    }
#if color_pass
    pass_color[item] = vec2u(pack2x16float(color.rg), pack2x16float(color.ba));
#end
    // Where the backdrop shows, its gradient would have bands.
    let noise = select(0.0, 1.0, sum.a < 0.5);
    let at = picture.rectangle.xy + pixel;
    frame_pixels[at.y * picture.frame_width + at.x] = finished(color, pixel, noise);
}
