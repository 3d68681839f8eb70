// 2 δ h c Σⱼ Vⱼ (ρⱼ − ρᵢ − ρᵢⱼᴴ) (−1/r) dW/dr between particles of one fluid (Fourtakas 2019).

struct DensityDiffusion {
    at_rest: Vector, // what density gains along gravity at rest, which must not diffuse: dρ/ρ₀ = (ρ/ρ₀)^(2−γ) g·dx/c², 1/m
    diffused: f32, // 1/m²
}

fn density_diffusion_begin(own: Own, density: ptr<function, Density>) {
    density.density_diffusion.at_rest = first(parameters.gravity) * first(fluid.closed)
        * (fluid.inverse_sound_squared * (1.0 + (2.0 - f32(GAMMA)) * own.deviation));
}

fn density_diffusion_pair(own: Own, other: Neighbor, density: ptr<function, Density>) {
    let gained = dot(density.density_diffusion.at_rest, other.s);
    let mixes = !other.wall && same_material(own.index, other.index);
    density.density_diffusion.diffused -= select(0.0, other.weight * (other.deviation - own.deviation - gained), mixes);
}

fn density_diffusion_end(own: Own, density: ptr<function, Density>) {
    density.rate += fluid.diffusion * density.density_diffusion.diffused;
}
