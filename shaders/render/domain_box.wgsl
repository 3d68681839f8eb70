// The domain, in red lines (Harada 2007, Figure 2); in 2D the four edges in the plane.

#import render/picture
#import render/line

@vertex
fn place_domain_edge(@builtin(vertex_index) index: u32, @builtin(instance_index) edge: u32) -> @builtin(position) vec4f {
    let low = picture.domain_min.xyz;
    let size = picture.domain_max.xyz - low;
#if two_dimensional
    // Edges along x and y with z = 0 are 0, 1, 4 and 5.
    let which = edge + (edge & 2u);
#else
    let which = edge;
#end
    return line_corner(low + size * box_edge(which, 0.0), low + size * box_edge(which, 1.0), index);
}

// Edges of a glass tank.
@fragment
fn draw_glass() -> @location(0) vec4f {
    return vec4f(0.30, 0.34, 0.37, 1.0);
}

@fragment
fn draw_red() -> @location(0) vec4f {
    return vec4f(0.72, 0.02, 0.03, 1.0);
}
