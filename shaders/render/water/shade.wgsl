// The color of water at a sample: reflection by Fresnel's law (Schlick 1994), what lies behind it, refracted (Snell) and
// absorbed (Beer and Lambert), light from within, the sun's glint.

#import render/picture
#import render/water/water
#import render/water/normal
#import render/water/surroundings

const F0: f32 = 0.02; // of water: ((n - 1) / (n + 1))²
const INVERSE_INDEX: f32 = 0.7519; // 1 / 1.33
const FILM: f32 = 2.5; // spacings

var scene_depth: texture_depth_2d;
var water_thickness: texture_2d<f32>;
var<storage, read> behind: array<vec2u>;

// Metres of water along the ray through a pixel.
fn thickness_at(pixel: vec2f) -> f32 {
    let last = vec2f(textureDimensions(water_thickness) - 1u);
    let at = clamp(0.5 * pixel - 0.5, vec2f(0.0), last);
    let low = vec2u(at);
    let high = min(low + 1u, vec2u(last));
    let share = at - vec2f(low);
    let upper = mix(textureLoad(water_thickness, low, 0), textureLoad(water_thickness, vec2u(high.x, low.y), 0), share.x);
    let lower = mix(textureLoad(water_thickness, vec2u(low.x, high.y), 0), textureLoad(water_thickness, high, 0), share.x);
    return mix(upper, lower, share.y).r * water.spacing;
}

fn behind_at(pixel: vec2u) -> vec4f {
    let packed = behind[pixel.y * picture.rectangle.z + pixel.x];
    return vec4f(unpack2x16float(packed.x), unpack2x16float(packed.y));
}

fn behind_between(pixel: vec2f) -> vec4f {
    let last = vec2f(picture.rectangle.zw - 1u);
    let at = clamp(pixel - 0.5, vec2f(0.0), last);
    let low = vec2u(at);
    let high = min(low + 1u, vec2u(last));
    let share = at - vec2f(low);
    let upper = mix(behind_at(low), behind_at(vec2u(high.x, low.y)), share.x);
    let lower = mix(behind_at(vec2u(low.x, high.y)), behind_at(high), share.x);
    return mix(upper, lower, share.y);
}

// The pixel where a refracted ray leaves the water; its own one where something in front of the water stands there.
fn refracted_pixel(own: vec2f, point: vec3f, distance: f32, direction: vec3f, thickness: f32) -> vec2f {
    let clip = picture.view_projection * vec4f(point + direction * thickness, 1.0);
    if clip.w <= 0.0 {
        return own;
    }
    let size = vec2f(picture.rectangle.zw);
    let at = clamp((vec2f(0.5, 0.5) + vec2f(0.5, -0.5) * clip.xy / clip.w) * size, vec2f(0.0), size - 0.01);
    let solid = textureLoad(scene_depth, vec2u(at * f32(picture.antialias)), 0);
    return select(at, own, view_depth(solid) < distance);
}

// Linear up to the knee, then towards 1.
fn shoulder(color: vec3f) -> vec3f {
    let knee = 0.7;
    let above = max(color - knee, vec3f(0.0));
    return min(color, vec3f(knee)) + (1.0 - knee) * above / (above + (1.0 - knee));
}

// Multiplied by its alpha.
fn water_color(place: vec2i, distance: f32) -> vec4f {
    let pixel = (vec2f(place) + 0.5) / f32(picture.antialias);
    let point = point_at(place, distance);
    let toward = to_eye(point).xyz;
    let normal = surface_normal(place, distance, toward);
    let thickness = thickness_at(pixel);

    let facing = saturate(dot(normal, toward));
    // Where there is less water than a particle's, spheres end, whose rims would shine.
    let whole = smoothstep(0.0, water.spacing, thickness);
    let fresnel = whole * (F0 + (1.0 - F0) * pow(1.0 - facing, 5.0));
    let mirrored = reflect(-toward, normal);
    let reflection = surroundings(point, mirrored);

    let bent = refract(-toward, normal, INVERSE_INDEX);
    let beyond = behind_between(refracted_pixel(pixel, point, distance, bent, thickness));
    // Thin water absorbs as a film of some thickness does, so that outlines do not fade into what is behind.
    let film = FILM * water.spacing * smoothstep(0.2, 0.9, thickness / water.spacing);
    let squares = vec2f(thickness * thickness, film * film);
    let passed = exp(-water.absorption.rgb * sqrt(length(squares)));
    let day = 0.75 + 0.25 * dot(normal, picture.light.xyz);
    // Even a film of water is no less blue than one as thick as a particle.
    let within = water.scatter.rgb * day * (1.0 - passed * exp(-water.absorption.rgb * water.spacing));

    let glint = 0.8 * whole * pow(saturate(dot(mirrored, picture.light.xyz)), 120.0);
    let color = mix(within + beyond.rgb * passed, reflection, fresnel) + glint;
    let alpha = 1.0 - (1.0 - fresnel) * dot(passed, vec3f(0.3333)) * (1.0 - beyond.a);
    return vec4f(shoulder(color), alpha);
}
