// Particles of water as spheres: their fronts for the surface, their chords for the thickness, seen by the eye and by the
// light.

#import render/water/sphere

var scene_depth: texture_depth_2d;

// A particle of the surface.
@vertex
fn place_water_surface(@builtin(vertex_index) index: u32, @builtin(instance_index) i: u32) -> Corner {
    var corner: Corner;
    corner.clip = NOWHERE;
    if is_drawn(i) && !is_drop(i) && !is_deep(i) {
        corner = sphere_corner(index, i, surface_radius(i));
    }
    return corner;
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

// A sphere whose chords are added.
struct Ball {
    @builtin(position) clip: vec4f,
    @location(0) offset: vec2f, // from the center, in radii
    @location(1) @interpolate(flat) radius: f32,
    @location(2) @interpolate(flat) depth: f32, // of the center
}

// A chord as a share of the diameter. It is exact from afar; up close, rays cut the sphere at a slant.
fn chord(ball: Ball) -> f32 {
    return sqrt(max(1.0 - dot(ball.offset, ball.offset), 0.0));
}

@vertex
fn place_water_thickness(@builtin(vertex_index) index: u32, @builtin(instance_index) i: u32) -> Ball {
    var ball: Ball;
    ball.clip = NOWHERE;
    if is_drawn(i) && !is_drop(i) {
        ball.radius = mix(water.drop_radius, water.reach, crowd(i));
        ball.offset = strip_corner(index);
        ball.clip = sphere_corner(index, i, ball.radius).clip;
        let center = picture.view_projection * vec4f(to_3d(unpack(position[i])), 1.0);
        ball.depth = center.z / center.w;
    }
    return ball;
}

@fragment
fn add_water_thickness(ball: Ball) -> @location(0) vec4f {
    let share = chord(ball);
    let size = vec2f(textureDimensions(scene_depth));
    let place = ball.clip.xy / vec2f((picture.rectangle.zw + 1u) / 2u);
    if share == 0.0 || ball.depth > textureLoad(scene_depth, vec2u(min(place * size, size - 1.0)), 0) {
        discard;
    }
    return thickness(share, ball.radius);
}

@vertex
fn place_water_shadow(@builtin(vertex_index) index: u32, @builtin(instance_index) i: u32) -> Ball {
    var ball: Ball;
    ball.clip = NOWHERE;
    if is_drawn(i) {
        ball.radius = mix(water.drop_radius, water.reach, crowd(i));
        ball.offset = strip_corner(index);
        let half = ball.radius / picture.light.w * 2.0 / f32(SHADOW_TEXELS);
        let center = picture.light_projection * vec4f(to_3d(unpack(position[i])), 1.0);
        ball.clip = center + vec4f(ball.offset * half, 0.0, 0.0);
    }
    return ball;
}

@fragment
fn add_water_shadow(ball: Ball) -> @location(0) vec4f {
    let share = chord(ball);
    if share == 0.0 {
        discard;
    }
    return thickness(share, ball.radius);
}
