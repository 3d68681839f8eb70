// Samples to pixels: a box filter in linear light over the backdrop, then sRGB bytes.

#import common/thread
#import render/picture
#import render/backdrop
#import render/put_pixel
#import render/scene_pixel

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
    // Where the backdrop shows, its gradient would have bands.
    let noise = select(0.0, 1.0, sum.a < 0.5);
    put_pixel(pixel, color, noise);
}
