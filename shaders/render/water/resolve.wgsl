// Samples to pixels where water is drawn: its surface where it is in front, otherwise the scene, over the backdrop.

#import common/thread
#import render/picture
#import render/backdrop
#import render/pixel
#import render/water/shade

var scene_color: texture_2d<f32>;
var<storage, read_write> frame_pixels: array<u32>;
#if color_pass
var<storage, read_write> pass_color: array<vec2u>; // half floats, multiplied by alpha
#end

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
    let color = sum / f32(n * n);
#if color_pass
    pass_color[item] = vec2u(pack2x16float(color.rg), pack2x16float(color.ba));
#end
    let at = picture.rectangle.xy + pixel;
    frame_pixels[at.y * picture.frame_width + at.x] = finished(color, pixel, 1.0);
}
