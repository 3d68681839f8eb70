// Particles of water as spheres: their fronts for the surface, their chords for the thickness, seen by the eye and by the
// light.

#import render/water/sphere

var scene_depth: texture_depth_2d;

// A particle of the surface, in between smaller where it has few neighbors.
fn surface_corner(index: u32, i: u32, full_radius: f32) -> Corner {
    var corner: Corner;
    corner.clip = NOWHERE;
    if is_drawn(i) && !is_drop(i) {
        corner = sphere_corner(index, i, mix(water.drop_radius, full_radius, crowd(i)));
    }
    return corner;
}

@vertex
fn place_water_surface(@builtin(vertex_index) index: u32, @builtin(instance_index) i: u32) -> Corner {
    return surface_corner(index, i, water.radius);
}

// The sphere's front, cut where the domain ends: water stands flat against the walls.
@fragment
fn cut_water_surface(corner: Corner) -> @builtin(frag_depth) f32 {
    let ray = hit_within_walls(corner);
    if ray.enters >= ray.leaves {
        discard;
    }
    let clip = picture.view_projection * vec4f(corner.point + ray.enters * ray.direction, 1.0);
    return clip.z / clip.w;
}

// Spacings of water along a chord, `share` of the diameter. The integral over the sphere's area is the particle's volume.
// Half floats add up multiples of 1/32 exactly up to 64, so the sum does not depend on the particles' order.
fn thickness(share: f32, radius: f32) -> vec4f {
    let volume = min(water.volume, 4.18879 * radius * radius * radius);
    let along = 0.477465 * share * volume / (radius * radius * water.spacing); // 3 / 2π
    return vec4f(round(32.0 * along) / 32.0, 0.0, 0.0, 0.0);
}

@vertex
fn place_water_thickness(@builtin(vertex_index) index: u32, @builtin(instance_index) i: u32) -> Corner {
    return surface_corner(index, i, water.reach);
}

@fragment
fn add_water_thickness(corner: Corner) -> @location(0) vec4f {
    let ray = hit(corner);
    let size = vec2f(textureDimensions(scene_depth));
    let share = corner.clip.xy / vec2f((picture.rectangle.zw + 1u) / 2u);
    let solid = textureLoad(scene_depth, vec2u(min(share * size, size - 1.0)), 0);
    let center = picture.view_projection * vec4f(corner.sphere.xyz, 1.0);
    if ray.enters >= ray.leaves || center.z / center.w > solid {
        discard;
    }
    return thickness((ray.leaves - ray.enters) / (2.0 * corner.sphere.w), corner.sphere.w);
}

struct Caster {
    @builtin(position) clip: vec4f,
    @location(0) offset: vec2f,
    @location(1) @interpolate(flat) radius: f32,
}

@vertex
fn place_water_shadow(@builtin(vertex_index) index: u32, @builtin(instance_index) i: u32) -> Caster {
    var caster: Caster;
    caster.clip = NOWHERE;
    if is_drawn(i) {
        caster.radius = mix(water.drop_radius, water.reach, crowd(i));
        caster.offset = strip_corner(index);
        let half = caster.radius / picture.light.w * 2.0 / f32(SHADOW_TEXELS);
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
    return thickness(sqrt(half2), caster.radius);
}
