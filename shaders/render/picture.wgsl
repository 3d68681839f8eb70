// What every picture pass knows: camera, light, range of the colors, size of the target. Metres; colors are linear.

struct Picture {
    view_projection: mat4x4f,
    light_projection: mat4x4f,
    eye: vec4f, // w: 1 in perspective, 0 in an orthographic view
    right: vec4f,
    up: vec4f,
    forward: vec4f,
    lens: vec4f, // half width and height of the view (at distance one in perspective), shift of the axis in NDC
    light: vec4f, // towards it; w: metres a texel of the shadow map
    domain_min: vec4f,
    domain_max: vec4f,
    floor_color: vec4f, // w: how much of it a shadow takes away
    backdrop_low: vec4f,
    backdrop_high: vec4f,
    rectangle: vec4u, // of the scene in the frame: x, y, width, height
    radius: f32, // as drawn
    color_low: f32,
    color_scale: f32,
    line_width: f32, // samples
    floor_height: f32,
    floor_fade_begin: f32, // distances from the domain's center
    floor_fade_end: f32,
    near: f32,
    far: f32,
    antialias: u32, // samples along a pixel's side
    frame_width: u32,
    count: u32, // particles
}

// In a storage buffer, since Mesa's llvmpipe compiles shaders anew, and keeps them, in every frame in which they branch on
// a uniform.
var<storage, read> picture: Picture;

// Direction from a point to the eye, and the distance (1 in an orthographic view).
fn to_eye(point: vec3f) -> vec4f {
    let away = picture.eye.xyz - point;
    let distance = length(away);
    if picture.eye.w > 0.5 {
        return vec4f(away / distance, distance);
    }
    return vec4f(-picture.forward.xyz, 1.0);
}

// Distance along the view's axis of a depth-buffer value.
fn view_depth(depth: f32) -> f32 {
    let near = picture.near;
    let far = picture.far;
    if picture.eye.w > 0.5 {
        return near * far / (far - depth * (far - near));
    }
    return near + depth * (far - near);
}
