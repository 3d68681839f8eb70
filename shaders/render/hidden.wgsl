// Whether a sphere can be seen at all, and how open its surroundings are towards the eye.

#import render/picture
#import render/splat_quad

var occluder_depth: texture_depth_2d;
var<storage, read> block_depth: array<f32>;

fn to_pixels(clip: vec4f) -> vec2f {
    return vec2f(0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w) * vec2f(picture.rectangle.zw);
}

fn is_hidden(center: vec3f, radius: f32) -> bool {
    let quad = splat_quad(center, radius);
    var low = vec2f(1e9);
    var high = vec2f(-1e9);
    for (var c = 0u; c < 4u; c += 1u) {
        let at = strip_corner(c) * quad.half;
        let clip = picture.view_projection * vec4f(center + quad.across * at.x + quad.up * at.y, 1.0);
        if clip.w <= 0.0 {
            return false;
        }
        let pixel = to_pixels(clip);
        low = min(low, pixel);
        high = max(high, pixel);
    }
    let size = vec2f(picture.rectangle.zw);
    if any(high < vec2f(0.0)) || any(low > size) {
        return true;
    }
    let nearest = picture.view_projection * vec4f(center - picture.forward.xyz * radius, 1.0);
    if nearest.w <= 0.0 {
        return false;
    }
    let depth = nearest.z / nearest.w;
    let blocks = (picture.rectangle.zw + OCCLUSION_BLOCK - 1u) / OCCLUSION_BLOCK;
    let first_block = vec2u(max(low, vec2f(0.0))) / OCCLUSION_BLOCK;
    let last_block = min(vec2u(clamp(high, vec2f(0.0), size)) / OCCLUSION_BLOCK, blocks - 1u);
    let spread = last_block - first_block + 1u;
    if spread.x * spread.y > 64u {
        return false;
    }
    for (var y = first_block.y; y <= last_block.y; y += 1u) {
        for (var x = first_block.x; x <= last_block.x; x += 1u) {
            if depth <= block_depth[y * blocks.x + x] {
                return false;
            }
        }
    }
    return true;
}

// Share of the directions around a sphere, on screen, that no nearer sphere stands in: 0 to 1.
fn openness(center: vec3f, radius: f32) -> f32 {
    let clip = picture.view_projection * vec4f(center, 1.0);
    let distance = select(1.0, clip.w, picture.eye.w > 0.5);
    let pixels = radius * f32(picture.rectangle.w) / (2.0 * picture.lens.y * distance);
    let middle = to_pixels(clip);
    let depth = view_depth(clip.z / clip.w);
    let last = vec2f(picture.rectangle.zw) - 1.0;
    var covered = 0.0;
    for (var k = 0u; k < 12u; k += 1u) {
        // Two rings, at 1.7 and 3.4 radii.
        let angle = f32(k) * 1.0472;
        let reach = select(1.7, 3.4, k >= 6u) * pixels;
        let place = clamp(middle + vec2f(cos(angle + 0.3), sin(angle + 0.3)) * reach, vec2f(0.0), last);
        let before = (depth - view_depth(textureLoad(occluder_depth, vec2u(place), 0))) / radius;
        // Nearer by a radius begins to cover; what is far in front belongs to something else.
        covered += saturate((before - 0.4) * 0.6) * saturate(3.0 - 0.25 * before);
    }
    return 1.0 - 0.75 * covered / 12.0;
}
