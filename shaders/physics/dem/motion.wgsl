// Something linear and something angular, packed: velocities, accelerations.

struct Motion {
    linear: vec4f,
    angular: vec4f,
}
