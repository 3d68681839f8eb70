// Each particle's color, once a frame: sRGB bytes, and in the highest byte its openness (0: cannot be seen).

#import common/vector
#import common/thread
#import render/picture
#import <column>
#import render/state
#if occlusion
#import render/drawn
#import render/hidden
#end

var<storage, read> color_map: array<u32>;
var<storage, read_write> splat: array<u32>;

@compute @workgroup_size(GROUP_SIZE)
fn color_splats(thread: Thread) {
    let i = item_index(thread);
    if i >= picture.count {
        return;
    }
    var open = 255u;
#if occlusion
    let center = to_3d(unpack(position[i]));
    if is_hidden(center, drawn_radius(i)) {
        splat[i] = 0u;
        return;
    }
    open = max(u32(openness(center, drawn_radius(i)) * 255.0 + 0.5), 1u);
#end
    let share = saturate((column(i) - picture.color_low) * picture.color_scale);
    splat[i] = color_map[u32(share * 255.0 + 0.5)] | (open << 24u);
}
