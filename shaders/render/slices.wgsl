// The voxels that each slice allocated, as translucent green boxes with stronger edges (Harada 2007, Figure 2),
// straight from the records that the neighbor search wrote.

#import common/vector
#import render/picture
#import render/splat_quad
#import render/line
#import cells/grid

// First voxel in the pool, corner along u and w, extent along u; one a slice (with
// regions: of each region, one region after the other), and one whose x is the total.
var<storage, read> slice_record: array<vec4i>;

struct Slab {
    low: vec3f,
    size: vec3f, // zero where the slice is empty
}

// From the slices' order of axes (u, s, w) to x, y, z.
fn unpermute(usw: vec3f) -> vec3f {
    return select(select(usw, usw.yxz, grid.axis == 0u), usw.xzy, grid.axis == 2u);
}

fn slab(s: u32) -> Slab {
    let record = slice_record[s];
    let voxels = slice_record[s + 1u].x - record.x;
    var box: Slab;
    if record.w <= 0 || voxels <= 0 {
        return box;
    }
    let extent = vec3f(f32(record.w), 1.0, f32(voxels / record.w));
    let corner = vec3f(f32(record.y), f32(i32(s) % (grid.high.y - grid.low.y) + grid.low.y), f32(record.z));
    box.low = unpermute(grid.lower.xyz + corner * grid.side);
    box.size = unpermute(extent * grid.side);
#if two_dimensional
    box.low.z = 0.0;
    box.size.z = 0.0;
#end
    return box;
}

// Sides: in 2D the rectangle itself; in 3D the four that stand across u and w, since slices lie face on face.
@vertex
fn place_slice_side(@builtin(vertex_index) index: u32, @builtin(instance_index) i: u32) -> @builtin(position) vec4f {
    let corner = strip_corner(index) * 0.5 + 0.5;
#if two_dimensional
    let box = slab(i);
    let at = vec3f(corner, 0.0);
#else
    let box = slab(i >> 2u);
    let far = f32(i & 1u);
    let at = unpermute(select(vec3f(far, corner), vec3f(corner, far), (i & 2u) != 0u));
#end
    if box.size.x <= 0.0 {
        return NOWHERE;
    }
    return picture.view_projection * vec4f(box.low + box.size * at, 1.0);
}

@vertex
fn place_slice_edge(@builtin(vertex_index) index: u32, @builtin(instance_index) i: u32) -> @builtin(position) vec4f {
#if two_dimensional
    let box = slab(i / 4u);
    let edge = i % 4u + (i & 2u);
#else
    let box = slab(i / 12u);
    let edge = i % 12u;
#end
    if box.size.x <= 0.0 {
        return NOWHERE;
    }
    return line_corner(box.low + box.size * box_edge(edge, 0.0), box.low + box.size * box_edge(edge, 1.0), index);
}

// Colors stand multiplied by their alpha.
@fragment
fn fill_green() -> @location(0) vec4f {
    return vec4f(0.02, 0.60, 0.12, 1.0) * 0.08;
}

@fragment
fn edge_green() -> @location(0) vec4f {
    return vec4f(0.01, 0.42, 0.08, 1.0) * 0.30;
}
