// A share from 0 to 1 that a number has by chance, the same every time (the last step of PCG; O'Neill 2014).
fn random_share(number: u32) -> f32 {
    let state = number * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return f32(((word >> 22u) ^ word) >> 8u) / 16777216.0;
}
