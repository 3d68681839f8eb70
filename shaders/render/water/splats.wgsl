// Particles of water as spheres: their front for the surface, their chords for the thickness, seen from the eye and from
// the light.

#import render/state
#import render/drawn
#import render/picture
#import render/splat_quad
#import <column>
#import render/water/water

var scene_depth: texture_depth_2d;

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) point: vec3f, // on the square
    @location(1) @interpolate(flat) sphere: vec4f, // center, radius
    @location(2) @interpolate(flat) crowd: f32,
}

// 0 for a particle with few neighbors, 1 inside the water; the column is the number of neighbors.
fn crowd(i: u32) -> f32 {
    return smoothstep(water.few, water.many, column(i));
}

fn place(index: u32, i: u32, full_radius: f32) -> Corner {
    var corner: Corner;
    corner.clip = NOWHERE;
    if is_drawn(i) {
        corner.crowd = crowd(i);
        let radius = mix(water.drop_radius, full_radius, corner.crowd);
        let center = to_3d(unpack(position[i]));
        let quad = splat_quad(center, radius);
        let at = strip_corner(index) * quad.half;
        corner.point = center + quad.across * at.x + quad.up * at.y;
        corner.clip = picture.view_projection * vec4f(corner.point, 1.0);
        corner.sphere = vec4f(center, radius);
    }
    return corner;
}

struct Hit {
    direction: vec3f,
    // Where the ray enters and leaves the sphere, from the square on; none where `enters` is not below `leaves`.
    enters: f32,
    leaves: f32,
}

fn hit(point: vec3f, sphere: vec4f) -> Hit {
    var found: Hit;
    found.direction = -to_eye(point).xyz;
    let center = sphere.xyz - point;
    let along = dot(center, found.direction);
    let beside = center - along * found.direction;
    let half2 = sphere.w * sphere.w - dot(beside, beside);
    let half = sqrt(max(half2, 0.0));
    found.enters = along - half;
    found.leaves = along + half;
    return found;
}

@vertex
fn place_water_surface(@builtin(vertex_index) index: u32, @builtin(instance_index) i: u32) -> Corner {
    return place(index, i, water.radius);
}

// The sphere's front, cut where the domain ends: water stands flat against the walls.
@fragment
fn cut_water_surface(corner: Corner) -> @builtin(frag_depth) f32 {
    let ray = hit(corner.point, corner.sphere);
    let slope = select(ray.direction, vec3f(1e-9), abs(ray.direction) < vec3f(1e-9));
    let low = (picture.domain_min.xyz - corner.point) / slope;
    let high = (picture.domain_max.xyz - corner.point) / slope;
    let nearest = min(low, high);
    let farthest = max(low, high);
    let enters = max(ray.enters, max(nearest.x, max(nearest.y, nearest.z)));
    let leaves = min(ray.leaves, min(farthest.x, min(farthest.y, farthest.z)));
    if enters >= leaves {
        discard;
    }
    let clip = picture.view_projection * vec4f(corner.point + enters * ray.direction, 1.0);
    return clip.z / clip.w;
}

// Spacings of water along a chord, and how much of it is spray. The integral over the sphere's area is its volume.
fn chord(share: f32, radius: f32, crowded: f32) -> vec4f {
    let volume = min(water.volume, 4.18879 * radius * radius * radius);
    let along = 0.477465 * share * volume / (radius * radius * water.spacing); // 3 / 2π
    return vec4f(along, along * (1.0 - crowded), 0.0, 0.0);
}

@vertex
fn place_water_thickness(@builtin(vertex_index) index: u32, @builtin(instance_index) i: u32) -> Corner {
    return place(index, i, water.reach);
}

@fragment
fn add_water_thickness(corner: Corner) -> @location(0) vec4f {
    let ray = hit(corner.point, corner.sphere);
    let size = vec2f(textureDimensions(scene_depth));
    let share = corner.clip.xy / vec2f((picture.rectangle.zw + 1u) / 2u);
    let solid = textureLoad(scene_depth, vec2u(min(share * size, size - 1.0)), 0);
    let center = picture.view_projection * vec4f(corner.sphere.xyz, 1.0);
    if ray.enters >= ray.leaves || center.z / center.w > solid {
        discard;
    }
    return chord((ray.leaves - ray.enters) / (2.0 * corner.sphere.w), corner.sphere.w, corner.crowd);
}

struct Caster {
    @builtin(position) clip: vec4f,
    @location(0) offset: vec2f,
    @location(1) @interpolate(flat) radius_crowd: vec2f,
}

@vertex
fn place_water_shadow(@builtin(vertex_index) index: u32, @builtin(instance_index) i: u32) -> Caster {
    var caster: Caster;
    caster.clip = NOWHERE;
    if is_drawn(i) {
        let crowded = crowd(i);
        let radius = mix(water.drop_radius, water.reach, crowded);
        caster.offset = strip_corner(index);
        caster.radius_crowd = vec2f(radius, crowded);
        let half = radius / picture.light.w * 2.0 / f32(SHADOW_TEXELS);
        let center = picture.light_projection * vec4f(to_3d(unpack(position[i])), 1.0);
        caster.clip = center + vec4f(caster.offset * half, 0.0, 0.0);
    }
    return caster;
}

@fragment
fn add_water_shadow(caster: Caster) -> @location(0) vec4f {
    let half2 = 1.0 - dot(caster.offset, caster.offset);
    if half2 <= 0.0 {
        discard;
    }
    return chord(sqrt(half2), caster.radius_crowd.x, caster.radius_crowd.y);
}
