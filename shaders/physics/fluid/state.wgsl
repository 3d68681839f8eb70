// Density and pressure of every particle.

// x: ρ/ρ₀ − 1, y: pressure, Pa.
#if writes_state
var<storage, read_write> fluid_state: array<vec2f>;
#else
var<storage, read> fluid_state: array<vec2f>;
#end

// Of a particle, m³.
fn volume_at(deviation: f32) -> f32 {
    return fluid.volume / (1.0 + deviation);
}
