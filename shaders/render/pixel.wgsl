// A pixel's color as the frame holds it.

fn to_srgb(linear: vec3f) -> vec3f {
    let c = saturate(linear);
    return select(1.055 * pow(c, vec3f(1.0 / 2.4)) - 0.055, 12.92 * c, c <= vec3f(0.0031308));
}

// sRGB bytes of a linear color, which stands multiplied by its alpha. `noise` steps of ordered noise work against bands in
// gradients.
fn finished(color: vec4f, pixel: vec2u, noise: f32) -> u32 {
    let bayer = f32((pixel.x ^ pixel.y) & 1u) * 0.5 + f32(pixel.y & 1u) * 0.25 - 0.375;
    let dither = bayer / 255.0 * noise;
#if transparent
    let alpha = saturate(color.a);
    return pack4x8unorm(vec4f(to_srgb(color.rgb / max(alpha, 1e-6)) + dither, alpha));
#else
    return pack4x8unorm(vec4f(to_srgb(color.rgb) + dither, 1.0));
#end
}
