// Points and normals of the surface.

#import render/picture
#import render/water/water
#if water_mesh
#import render/water/packed_normal

var water_normal: texture_2d<u32>;
#end

var<storage, read> water_surface: array<f32>;

fn samples() -> vec2i {
    return vec2i(picture.rectangle.zw * picture.antialias);
}

fn surface_at(place: vec2i) -> f32 {
    let size = samples();
    if any(place < vec2i(0)) || any(place >= size) {
        return NO_SURFACE;
    }
    return water_surface[place.y * size.x + place.x];
}

// The point that the middle of a sample sees at a distance along the view's axis.
fn point_at(place: vec2i, distance: f32) -> vec3f {
    let middle = (vec2f(place) + 0.5) / vec2f(samples());
    let ndc = vec2f(2.0 * middle.x - 1.0, 1.0 - 2.0 * middle.y) - picture.lens.zw;
    let sideways = picture.right.xyz * (ndc.x * picture.lens.x) + picture.up.xyz * (ndc.y * picture.lens.y);
    let scale = select(1.0, distance, picture.eye.w > 0.5);
    return picture.eye.xyz + picture.forward.xyz * distance + sideways * scale;
}

#if water_mesh
// The mesh's unit normal, turned to the eye's side at rims.
fn surface_normal(place: vec2i, own: f32, toward_eye: vec3f) -> vec3f {
    let normal = unpack_normal(textureLoad(water_normal, place, 0).r);
    return normalize(normal + (1e-3 - min(dot(normal, toward_eye), 0.0)) * toward_eye);
}
#else
// How the surface goes on along a direction: on both sides where it does, otherwise on the side where its distance changes
// less, so that outlines stay sharp.
fn tangent(place: vec2i, own: f32, direction: vec2i) -> vec3f {
    let before = surface_at(place - direction);
    let behind = surface_at(place + direction);
    let change = abs(vec2f(before, behind) - own);
    if max(change.x, change.y) < 0.5 * water.retreat {
        return point_at(place + direction, behind) - point_at(place - direction, before);
    }
    if change.y <= change.x {
        return point_at(place + direction, behind) - point_at(place, own);
    }
    return point_at(place, own) - point_at(place - direction, before);
}

// The unit normal on the eye's side.
fn surface_normal(place: vec2i, own: f32, toward_eye: vec3f) -> vec3f {
    let across = tangent(place, own, vec2i(1, 0));
    let down = tangent(place, own, vec2i(0, 1));
    let normal = cross(down, across);
    let length2 = dot(normal, normal);
    if !(length2 > 0.0) || length2 > 1e30 {
        return toward_eye;
    }
    let unit = normal * inverseSqrt(length2);
    return select(-unit, unit, dot(unit, toward_eye) > 0.0);
}
#end
