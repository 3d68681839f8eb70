// Grains that are matte, each with a surface of its own: `own_surface` of render/looks/NAME.

#import render/picture
#import render/lighting
#import render/random_share

// What a grain looks like at a place.
struct Matte {
    albedo: vec3f,
    normal: vec3f,
}

// What all of a grain knows: a turn by chance as a quaternion, and how much of its surface's detail its pixels can hold.
struct Grain {
    turn: vec4f,
    detail: f32,
}

// Radii, in pixels of the finished picture, at which detail begins to be seen, and is seen whole.
const DETAIL_BEGINS: f32 = 2.0;
const DETAIL_IS_WHOLE: f32 = 7.0;

// Every turn alike (Shoemake 1992).
fn grain_of(number: u32, radius: f32, distance: f32) -> Grain {
    let u = random_share(3u * number);
    let angles = 6.2831853 * vec2f(random_share(3u * number + 1u), random_share(3u * number + 2u));
    let turn = vec4f(sqrt(1.0 - u) * vec2f(sin(angles.x), cos(angles.x)), sqrt(u) * vec2f(sin(angles.y), cos(angles.y)));
    let pixels = radius * f32(picture.rectangle.w) / (2.0 * picture.lens.y * distance);
    return Grain(turn, smoothstep(DETAIL_BEGINS, DETAIL_IS_WHOLE, pixels));
}

fn turned(q: vec4f, v: vec3f) -> vec3f {
    return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v);
}

fn turned_back(q: vec4f, v: vec3f) -> vec3f {
    return turned(vec4f(-q.xyz, q.w), v);
}

// A rough surface lit as `shade` lights a smooth one (Oren and Nayar 1994, in the form of Fujii 2012); `round` is the normal of
// the sphere that stands for the grain.
fn shade_matte(seen: Matte, round: vec3f, toward_eye: vec3f, point: vec3f, openness: f32, pixel: vec2f) -> vec3f {
    let toward_light = picture.light.xyz;
    let to_light = max(dot(seen.normal, toward_light), 0.0);
    let facing = max(dot(seen.normal, toward_eye), 0.0);
    let apart = dot(toward_light, toward_eye) - to_light * facing;
    let back = apart / select(1.0, max(max(to_light, facing), 0.05), apart > 0.0);
    let key = to_light * max(MATTE_FLAT + MATTE_BACK * back, 0.0) * sunlit(point, round, pixel);
    let crevice = 0.55 + 0.45 * max(dot(round, toward_eye), 0.0);
    let light = (sky_light(seen.normal) * crevice + 0.08 * facing) * openness * openness + SUN * key;
    return soften(seen.albedo * light);
}

// Of slopes whose standard deviation σ is 30°: 1 - σ² / 2 (σ² + 0.33) and 0.45 σ² / (σ² + 0.09).
const MATTE_FLAT: f32 = 0.773;
const MATTE_BACK: f32 = 0.339;
