// Numbers of the fluid that never change during a run (physics::fluid::coefficients).

struct Fluid {
    support: f32, // where the kernel ends, m
    inverse_smoothing: f32, // 1/h, 1/m
    kernel_scale: f32, // factors of the kernel's value, its slope and its Laplacian
    slope_scale: f32,
    laplacian_scale: f32,
    volume: f32, // of a particle at rest, m³ (m² in 2D)
    density: f32, // at rest, kg/m³
    viscosity: f32, // dynamic, Pa·s
    stiffness: f32, // ρ₀c²/γ, Pa
    background_pressure: f32, // Pa
    inverse_sound_squared: f32, // 1/c², s²/m²
    diffusion: f32, // 2 δ h c, m²/s
    artificial_viscosity: f32, // α h c, m²/s
    wall_friction: f32, // Fanning's factor of walls that slip
    shifting: f32, // m²/s; times the step, the factor of the gradient of concentration
    shift_limit: f32, // of one step, m
    kernel_at_spacing: f32, // W at the distance of particles at rest
    smallest_square: f32, // keeps quotients by squared distances finite, m²
    lowest_deviation: f32, // of ρ/ρ₀ − 1 where negative pressures are clamped
    surface_tension: f32, // N/m
    wetting: f32, // cosine of the contact angle
    spacing: f32, // of particles at rest, m
    closed: vec4f, // 1 along directions in which space does not repeat, else 0
}

var<uniform> fluid: Fluid;
