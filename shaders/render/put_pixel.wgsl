// What becomes of a pixel's linear color, which stands multiplied by its alpha.

#if blurred
#import render/picture

// The sum over the pictures that a frame is the mean of.
var<storage, read_write> blur_sum: array<vec4f>;

fn put_pixel(pixel: vec2u, color: vec4f, noise: f32) {
    blur_sum[pixel.y * picture.rectangle.z + pixel.x] += color;
}
#else
#import render/write_pixel

fn put_pixel(pixel: vec2u, color: vec4f, noise: f32) {
    write_pixel(pixel, color, noise);
}
#end
