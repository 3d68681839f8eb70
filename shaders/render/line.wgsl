// A line segment as a quad of constant width on screen.

#import render/picture
#import render/splat_quad

// Corner `index` of the segment from `a` to `b`; the resolve's averaging smooths its edges.
fn line_corner(a: vec3f, b: vec3f, index: u32) -> vec4f {
    var from_ = picture.view_projection * vec4f(a, 1.0);
    var to_ = picture.view_projection * vec4f(b, 1.0);
    // Cut at the near plane, before dividing.
    let near = select(-1e30, 0.5 * picture.near, picture.eye.w > 0.5);
    if from_.w < near && to_.w < near {
        return NOWHERE;
    }
    if from_.w < near {
        from_ = mix(from_, to_, (near - from_.w) / (to_.w - from_.w));
    }
    if to_.w < near {
        to_ = mix(to_, from_, (near - to_.w) / (from_.w - to_.w));
    }
    let half_size = 0.5 * f32(picture.antialias) * vec2f(picture.rectangle.zw);
    let p = from_.xy / from_.w * half_size;
    let q = to_.xy / to_.w * half_size;
    let length_ = length(q - p);
    let along = select(vec2f(1.0, 0.0), (q - p) / length_, length_ > 1e-6);
    let at = strip_corner(index) * 0.5 * picture.line_width;
    var end = select(from_, to_, at.x > 0.0);
    let moved = select(p, q, at.x > 0.0) + along * at.x + vec2f(-along.y, along.x) * at.y;
    end.x = moved.x / half_size.x * end.w;
    end.y = moved.y / half_size.y * end.w;
    end.z -= 2e-5 * end.w; // in front of a surface that it lies on
    return end;
}

// The two ends of edge 0 to 11 of a box, as shares of its size: edges 0 to 3 run along x, 4 to 7 along y, 8 to 11
// along z.
fn box_edge(edge: u32, end: f32) -> vec3f {
    let one = f32(edge & 1u);
    let other = f32((edge >> 1u) & 1u);
    let axis = edge >> 2u;
    if axis == 0u {
        return vec3f(end, one, other);
    }
    if axis == 1u {
        return vec3f(one, end, other);
    }
    return vec3f(one, other, end);
}
