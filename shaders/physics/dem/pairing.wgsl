// Coefficients of a contact: of two grains, or of a grain and a wall. Their units are those of the contact law.

struct Pairing {
    stiffness: f32,
    damping: f32,
    shear_stiffness: f32,
    shear_damping: f32,
    friction: f32, // tangential over normal force, at most
    rolling_limit: f32, // torque over normal force, at most, m
    rolling_stiffness: f32, // N·m per radian, over the normal stiffness, m²
    rolling_damping: f32, // N·m·s, over the square root of the rolling stiffness, kg^½·m
    rolling_inertia: f32, // kg·m²
    @size(12) cohesion: f32, // greatest pull, N
}

// What a contact law makes of an overlap.
struct Response {
    force: f32, // that pushes apart while nothing moves, N
    stiffness: f32, // its slope, N/m
    damping: f32, // N·s/m
    shear_stiffness: f32, // N/m
    shear_damping: f32, // N·s/m
}
