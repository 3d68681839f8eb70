// Smooths the surface by a narrow-range filter (Truong and Yuksel 2018), one direction after the other: what is too far in
// front is left out with its counterpart on the other side, what is too far behind counts as a little behind. The filter is as
// wide in metres everywhere, so that it does not swim when the camera moves.

#import common/thread
#import render/picture
#import render/water/water

var<storage, read> water_surface: array<f32>;
var<storage, read_write> next_water_surface: array<f32>;

// Samples on each side; where the filter is wider, it skips some, which narrower ones after it make up for.
const TAPS: i32 = 12;

// `share` of the filter's whole width.
fn smooth_surface(item: u32, direction: vec2i, share: f32) {
    let size = vec2i(picture.rectangle.zw * picture.antialias);
    if item >= u32(size.x * size.y) {
        return;
    }
    let own = water_surface[item];
    let metre = f32(size.y) / (2.0 * picture.lens.y * select(1.0, own, picture.eye.w > 0.5)); // samples
    let width = share * water.smoothing * metre;
    if own == NO_SURFACE || width < 0.3 {
        next_water_surface[item] = own;
        return;
    }
    let center = vec2i(i32(item) % size.x, i32(item) / size.x);
    let reach = max(i32(min(2.0 * width, 4096.0)), 1);
    let stride = (reach + TAPS - 1) / TAPS;
    // Beyond the nearer edge of the picture, samples have no counterpart.
    let nearer = min(center, size - 1 - center);
    let last = min(reach, dot(nearer, direction));
    let step = direction.x + direction.y * size.x;
    let fall = -0.5 / (width * width);
    var low = own - water.range;
    var high = own + water.range;
    var sum = own;
    var weights = 1.0;
    for (var away = stride; away <= last; away += stride) {
        let before = water_surface[i32(item) - away * step];
        let behind = water_surface[i32(item) + away * step];
        if min(before, behind) < low {
            continue;
        }
        let weight = exp(fall * f32(away * away));
        sum += weight * (select(own + water.retreat, before, before <= high) + select(own + water.retreat, behind, behind <= high));
        weights += 2.0 * weight;
        // Slopes may go on.
        let near = min(before, behind);
        let far = max(select(own, before, before <= high), select(own, behind, behind <= high));
        low = min(low, near - water.range);
        high = max(high, far + water.range);
    }
    next_water_surface[item] = sum / weights;
}

@compute @workgroup_size(GROUP_SIZE)
fn smooth_rows(thread: Thread) {
    smooth_surface(item_index(thread), vec2i(1, 0), 0.8);
}

@compute @workgroup_size(GROUP_SIZE)
fn smooth_columns(thread: Thread) {
    smooth_surface(item_index(thread), vec2i(0, 1), 0.8);
}

@compute @workgroup_size(GROUP_SIZE)
fn smooth_rows_again(thread: Thread) {
    smooth_surface(item_index(thread), vec2i(1, 0), 0.4);
}

@compute @workgroup_size(GROUP_SIZE)
fn smooth_columns_again(thread: Thread) {
    smooth_surface(item_index(thread), vec2i(0, 1), 0.4);
}

@compute @workgroup_size(GROUP_SIZE)
fn smooth_rows_finely(thread: Thread) {
    smooth_surface(item_index(thread), vec2i(1, 0), 0.12);
}

@compute @workgroup_size(GROUP_SIZE)
fn smooth_columns_finely(thread: Thread) {
    smooth_surface(item_index(thread), vec2i(0, 1), 0.12);
}
