// The mean of a frame's pictures to pixels.

#import common/thread
#import render/write_pixel
#import render/subframe

var<storage, read> blur_sum: array<vec4f>;

@compute @workgroup_size(GROUP_SIZE)
fn finish_blur(thread: Thread) {
    let item = item_index(thread);
    let size = picture.rectangle.zw;
    if item < size.x * size.y {
        write_pixel(vec2u(item % size.x, item / size.x), blur_sum[item] * subframe.share, 1.0);
    }
}
