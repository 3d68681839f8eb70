// A particle of water as a sphere on screen, and where rays meet it.

#import render/state
#import render/drawn
#import render/picture
#import render/splat_quad
#import <column>
#import render/water/water
#import render/random_share

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) point: vec3f, // on the square
    @location(1) @interpolate(flat) sphere: vec4f, // center, radius
}

// Particles with few neighbors are drops: they belong to no surface. The column is the number of neighbors.
fn is_drop(i: u32) -> bool {
    return column(i) < water.few;
}

// Radius of a drop: no two are alike.
fn drop_radius(i: u32) -> f32 {
    return water.drop_radius * mix(1.5, 0.6, random_share(id[i]));
}

// 0 for a particle that is nearly a drop, 1 inside the water.
fn crowd(i: u32) -> f32 {
    return smoothstep(water.few, water.many, column(i));
}

// Of a particle's sphere in the surface: smaller where it has few neighbors, and that of a drop where it is one.
fn surface_radius(i: u32) -> f32 {
    return mix(drop_radius(i), water.radius, crowd(i));
}

// Whether others surround a particle on all sides: its sphere is behind theirs, wherever it is seen from.
fn is_deep(i: u32) -> bool {
    return column(i) >= water.deep;
}

// A corner of the square that covers a sphere.
fn sphere_corner(index: u32, i: u32, radius: f32) -> Corner {
    var corner: Corner;
    let center = to_3d(unpack(position[i]));
    let quad = splat_quad(center, radius);
    let at = strip_corner(index) * quad.half;
    corner.point = center + quad.across * at.x + quad.up * at.y;
    corner.clip = picture.view_projection * vec4f(corner.point, 1.0);
    corner.sphere = vec4f(center, radius);
    return corner;
}

struct Hit {
    direction: vec3f,
    // Where the ray enters and leaves the sphere, from the square on; nowhere where `enters` is not below `leaves`.
    enters: f32,
    leaves: f32,
}

fn hit(corner: Corner) -> Hit {
    var found: Hit;
    found.direction = -to_eye(corner.point).xyz;
    let center = corner.sphere.xyz - corner.point;
    let along = dot(center, found.direction);
    let beside = center - along * found.direction;
    let half = sqrt(max(corner.sphere.w * corner.sphere.w - dot(beside, beside), 0.0));
    found.enters = along - half;
    found.leaves = along + half;
    return found;
}

// The same of the part of the sphere that is within the tank's walls.
fn hit_within_walls(corner: Corner) -> Hit {
    var found = hit(corner);
    let slope = select(found.direction, vec3f(1e-9), abs(found.direction) < vec3f(1e-9));
    let low = (water.low.xyz - corner.point) / slope;
    let high = (water.high.xyz - corner.point) / slope;
    let nearest = min(low, high);
    let farthest = max(low, high);
    found.enters = max(found.enters, max(nearest.x, max(nearest.y, nearest.z)));
    found.leaves = min(found.leaves, min(farthest.x, min(farthest.y, farthest.z)));
    return found;
}
