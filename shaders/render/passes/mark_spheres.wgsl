// Which sphere the middle of each pixel sees.

#import render/state
#import render/drawn
#import render/picture
#import render/splat_quad
#import render/passes/marks

var<storage, read> splat: array<u32>;

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) offset: vec3f, // on the square, in units of its half side
    @location(1) @interpolate(flat) toward: vec4f, // w: rho
    @location(2) @interpolate(flat) center: vec3f,
    @location(3) @interpolate(flat) mark: u32,
#if sizes
    @location(4) @interpolate(flat) radius: f32,
#end
}

@vertex
fn place_marked_sphere(@builtin(vertex_index) index: u32, @builtin(instance_index) i: u32) -> Corner {
    var corner: Corner;
    corner.clip = NOWHERE;
    if splat[i] >= 0x1000000u && is_drawn(i) { // otherwise hidden
        let center = to_3d(unpack(position[i]));
        let quad = splat_quad(center, drawn_radius(i));
        let at = strip_corner(index);
        corner.offset = quad.across * at.x + quad.up * at.y;
        corner.clip = picture.view_projection * vec4f(center + corner.offset * quad.half, 1.0);
        corner.toward = vec4f(quad.toward, quad.rho);
        corner.center = center;
#if sizes
        corner.radius = drawn_radius(i);
#end
        corner.mark = i + 1u;
    }
    return corner;
}

@fragment
fn mark_sphere(corner: Corner) -> Mark {
    if dot(corner.offset, corner.offset) > 1.0 {
        discard;
    }
    let normal = sphere_normal(corner.offset, corner.toward.xyz, corner.toward.w);
#if sizes
    let radius = corner.radius;
#else
    let radius = picture.radius;
#end
    let clip = picture.view_projection * vec4f(corner.center + radius * normal, 1.0);
    return Mark(corner.mark, clip.z / clip.w);
}
