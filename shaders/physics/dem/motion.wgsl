// How grains move, packed.

// What a grain had half a step ago.
struct HalfStep {
    velocity: vec4f, // m/s; beside it, how long the last step was, s
    rotation: vec4f, // rad/s
    rest: vec4f, // of the way that was lost to rounding when it was added to the position, m
}

// Accelerations.
struct Motion {
    linear: vec4f,
    angular: vec4f,
}
