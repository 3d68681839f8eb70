// What a step notes of a fluid's particle for the length of the next one.
#import physics/extremes
#import physics/fluid/coefficients

// The local speed of sound of the Tait equation: c² = dp/dρ = c₀² (1 + e)^(γ − 1).
fn note_fluid(acceleration: Vector, v: Vector, deviation: f32) {
    let stiffened = pow(max(1.0 + deviation, 0.0), 0.5 * f32(GAMMA - 1u));
    note_extremes(acceleration, length(v), inverseSqrt(fluid.inverse_sound_squared) * stiffened);
}
