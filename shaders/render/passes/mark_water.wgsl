// Which particle of water the middle of each pixel sees: of the surface, or a drop.

#import render/water/sphere
#import render/passes/marks

struct MarkedCorner {
    @builtin(position) clip: vec4f,
    @location(0) point: vec3f,
    @location(1) @interpolate(flat) sphere: vec4f,
    @location(2) @interpolate(flat) mark: u32,
}

@vertex
fn place_marked_water(@builtin(vertex_index) index: u32, @builtin(instance_index) i: u32) -> MarkedCorner {
    var marked: MarkedCorner;
    marked.clip = NOWHERE;
    if is_drawn(i) && !is_deep(i) {
        let corner = sphere_corner(index, i, surface_radius(i));
        marked = MarkedCorner(corner.clip, corner.point, corner.sphere, i + 1u);
    }
    return marked;
}

@fragment
fn mark_water(marked: MarkedCorner) -> Mark {
    let corner = Corner(marked.clip, marked.point, marked.sphere);
    var ray = hit(corner);
    if !is_drop(marked.mark - 1u) {
        ray = hit_within_walls(corner);
    }
    if ray.enters >= ray.leaves {
        discard;
    }
    let clip = picture.view_projection * vec4f(marked.point + ray.enters * ray.direction, 1.0);
    return Mark(marked.mark, clip.z / clip.w);
}
