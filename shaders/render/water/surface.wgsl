// The surface that the eye sees, as distances along the view's axis, one per sample.

#import common/thread
#import render/picture
#import render/water/water

var water_depth: texture_depth_2d;
var<storage, read_write> water_surface: array<f32>;

@compute @workgroup_size(GROUP_SIZE)
fn find_water_surface(thread: Thread) {
    let size = picture.rectangle.zw * picture.antialias;
    let item = item_index(thread);
    if item >= size.x * size.y {
        return;
    }
    let depth = textureLoad(water_depth, vec2u(item % size.x, item / size.x), 0);
    water_surface[item] = select(view_depth(depth), NO_SURFACE, depth >= 1.0);
}
