// The index pool as a heatmap (Harada 2007, Figure 7): one texel a voxel in the pool's order, row by row, in a
// square; black empty, red one, yellow two, white three, blue four and more, magenta where indices were lost.

#import common/thread
#import storage/fold

struct PoolPanel {
    rectangle: vec4u, // of the panel in the frame: x, y, width, height
    square: vec4u, // room for the heatmap in the frame: x, y, side
    background: u32, // sRGB bytes
    frame_width: u32,
    // Colors by the number of indices, sRGB bytes.
    empty: u32,
    one: u32,
    two: u32,
    three: u32,
    four: u32,
    overflow: u32,
}

var<uniform> pool_panel: PoolPanel;
var<storage, read_write> frame_pixels: array<u32>;

fn color_of(count: u32) -> u32 {
    if count > SLOTS {
        return pool_panel.overflow;
    }
    switch count {
        case 0u: { return pool_panel.empty; }
        case 1u: { return pool_panel.one; }
        case 2u: { return pool_panel.two; }
        case 3u: { return pool_panel.three; }
        default: { return pool_panel.four; }
    }
}

@compute @workgroup_size(GROUP_SIZE)
fn paint_pool(thread: Thread) {
    let item = item_index(thread);
    let panel = pool_panel.rectangle;
    if item >= panel.z * panel.w {
        return;
    }
    let at = panel.xy + vec2u(item % panel.z, item / panel.z);
    let inside = at - pool_panel.square.xy; // wraps where outside
    var color = pool_panel.background;
    if inside.x < pool_panel.square.z && inside.y < pool_panel.square.z {
        let fullest = fullest_at(inside, pool_panel.square.z);
        color = select(color_of(fullest), pool_panel.background, fullest == NO_VOXEL);
    }
    frame_pixels[at.y * pool_panel.frame_width + at.x] = color;
}
