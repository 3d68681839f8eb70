// Samples to pixels where water is drawn: its surface where it is in front, otherwise the scene, over the backdrop.

#import common/thread
#import render/picture
#import render/backdrop
#import render/put_pixel
#import render/water/shade

var scene_color: texture_2d<f32>;

@compute @workgroup_size(GROUP_SIZE)
fn resolve_water(thread: Thread) {
    let item = item_index(thread);
    let size = picture.rectangle.zw;
    if item >= size.x * size.y {
        return;
    }
    let pixel = vec2u(item % size.x, item / size.x);
    let n = picture.antialias;
    var sum = vec4f(0.0);
    var clear = 0.0;
    for (var y = 0u; y < n; y += 1u) {
        for (var x = 0u; x < n; x += 1u) {
            let place = pixel * n + vec2u(x, y);
            let distance = surface_at(vec2i(place));
            // What lies in a wall of the tank, as its edges do, is in front of the water.
            if distance + 0.1 * water.spacing < view_depth(textureLoad(scene_depth, place, 0)) {
                sum += water_color(vec2i(place), distance);
            } else {
                let solid = textureLoad(scene_color, place, 0);
                sum += solid;
                clear += 1.0 - solid.a;
            }
        }
    }
    if clear > 0.0 {
        sum += clear * backdrop(vec2f(pixel) + 0.5);
    }
    put_pixel(pixel, sum / f32(n * n), 1.0);
}
