// A pixel's linear color, multiplied by its alpha, into the frame and into the extra image of it.

#import render/picture
#import render/pixel

var<storage, read_write> frame_pixels: array<u32>;
#if color_pass
var<storage, read_write> pass_color: array<vec2u>; // half floats
#end

fn write_pixel(pixel: vec2u, color: vec4f, noise: f32) {
#if color_pass
    pass_color[pixel.y * picture.rectangle.z + pixel.x] = vec2u(pack2x16float(color.rg), pack2x16float(color.ba));
#end
    let at = picture.rectangle.xy + pixel;
    frame_pixels[at.y * picture.frame_width + at.x] = finished(color, pixel, noise);
}
