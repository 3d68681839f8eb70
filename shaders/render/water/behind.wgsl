// What lies behind the water: the scene without it over the backdrop, one half-float color per pixel, multiplied by alpha.

#import common/thread
#import render/picture
#import render/backdrop
#import render/scene_pixel

var<storage, read_write> behind: array<vec2u>;

@compute @workgroup_size(GROUP_SIZE)
fn paint_behind(thread: Thread) {
    let item = item_index(thread);
    let size = picture.rectangle.zw;
    if item >= size.x * size.y {
        return;
    }
    let pixel = vec2u(item % size.x, item / size.x);
    var sum = scene_pixel(pixel);
    if sum.a < 0.999 {
        sum += (1.0 - sum.a) * backdrop(vec2f(pixel) + 0.5);
    }
    behind[item] = vec2u(pack2x16float(sum.rg), pack2x16float(sum.ba));
}
