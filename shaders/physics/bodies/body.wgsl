// Rigid bodies, and quaternions (x, y, z, w) that turn their own axes to the scene's. Turning is in three dimensions; in 2D
// all of it is about z.

struct BodyShape {
    first: u32, // id of its first particle
    count: u32, // of its particles
    inverse_mass: f32, // 1/kg
    grain_mass: f32, // of one grain, kg
    inverse_inertia: mat3x3f, // along the body's own axes, 1/(kg·m²)
}

struct BodyState {
    center: vec4f, // of mass, m; beside it, its mass over that of a grain
    center_rest: vec4f, // what rounding has left out of the center, m
    velocity: vec4f, // m/s
    half_velocity: vec4f, // half a step ago, m/s; beside it, how long the last step was, s
    angular_velocity: vec4f, // rad/s
    half_momentum: vec4f, // angular momentum half a step ago, kg·m²/s
    orientation: vec4f,
    orientation_rest: vec4f, // what rounding has left out of it
}

fn turned(orientation: vec4f, v: vec3f) -> vec3f {
    let aside = cross(orientation.xyz, v);
    return v + 2.0 * (orientation.w * aside + cross(orientation.xyz, aside));
}

fn turned_back(orientation: vec4f, v: vec3f) -> vec3f {
    return turned(vec4f(-orientation.xyz, orientation.w), v);
}

// What turning by `angle` (its direction is the axis, its length the angle, rad) adds to an orientation.
fn turning(orientation: vec4f, angle: vec3f) -> vec4f {
    let size = length(angle);
    // sin(size / 2) / size
    var share = 0.5 - size * size / 48.0;
    if size > 0.1 {
        share = sin(0.5 * size) / size;
    }
    let quarter = sin(0.25 * size);
    let less = -2.0 * quarter * quarter; // cos(size / 2) - 1
    let axis = share * angle;
    return vec4f(
        less * orientation.xyz + orientation.w * axis + cross(axis, orientation.xyz),
        less * orientation.w - dot(axis, orientation.xyz),
    );
}

// rad/s
fn angular_velocity_of(shape: BodyShape, orientation: vec4f, momentum: vec3f) -> vec3f {
    return turned(orientation, shape.inverse_inertia * turned_back(orientation, momentum));
}
