// Blocks of the occluders' depth: nothing behind a block's value can be seen through it.

#import common/thread
#import render/picture

var occluder_depth: texture_depth_2d;
var<storage, read_write> block_depth: array<f32>;

@compute @workgroup_size(GROUP_SIZE)
fn find_block_depth(thread: Thread) {
    let size = picture.rectangle.zw;
    let blocks = (size + OCCLUSION_BLOCK - 1u) / OCCLUSION_BLOCK;
    let item = item_index(thread);
    if item >= blocks.x * blocks.y {
        return;
    }
    let first_pixel = vec2u(item % blocks.x, item / blocks.x) * OCCLUSION_BLOCK;
    let end_pixel = min(first_pixel + OCCLUSION_BLOCK, size);
    var deepest = 0.0;
    for (var y = first_pixel.y; y < end_pixel.y; y += 1u) {
        for (var x = first_pixel.x; x < end_pixel.x; x += 1u) {
            deepest = max(deepest, textureLoad(occluder_depth, vec2u(x, y), 0));
        }
    }
    block_depth[item] = deepest;
}
