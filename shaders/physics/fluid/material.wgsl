// What a particle is made of.
#import physics/fluid/coefficients
#if several_materials
#import fields/material
#end

struct Material {
    density: f32, // at rest, kg/m³
    viscosity: f32, // dynamic, Pa·s
    stiffness: f32, // ρ₀c²/γ, Pa
    surface_tension: f32, // N/m
}

#if several_materials
var<uniform> materials: array<Material, MATERIALS>;

fn material_of(i: u32) -> Material {
    return materials[material[i]];
}

fn same_material(i: u32, j: u32) -> bool {
    return material[i] == material[j];
}
#else
fn material_of(i: u32) -> Material {
    return Material(fluid.density, fluid.viscosity, fluid.stiffness, fluid.surface_tension);
}

fn same_material(i: u32, j: u32) -> bool {
    return true;
}
#end

// Equation of state (Tait; Monaghan 1994): p₀ + B ((1 + e)^γ − 1) with e = ρ/ρ₀ − 1, free of cancellation.
fn pressure_at(stiffness: f32, deviation: f32) -> f32 {
    var power = deviation;
    for (var n = 1u; n < GAMMA; n++) {
        power = power * (1.0 + deviation) + deviation;
    }
    return fluid.background_pressure + stiffness * power;
}

// The inverse of it.
fn deviation_at(stiffness: f32, pressure: f32) -> f32 {
    let ratio = max(1.0 + (pressure - fluid.background_pressure) / stiffness, 0.0);
    return pow(ratio, 1.0 / f32(GAMMA)) - 1.0;
}

// Of a pressure, what the scene lets act.
fn allowed_pressure(pressure: f32) -> f32 {
#if clamped_pressure
    return max(pressure, 0.0);
#else
    return pressure;
#end
}
