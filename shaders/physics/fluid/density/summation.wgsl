// ρᵢ = ρ₀ V₀ Σⱼ Wᵢⱼ (Rojas 2013, Eq. 1).

struct Summation {
    sum: f32, // 1/m³
}

fn summation_begin(own: Own, density: ptr<function, Density>) {
    density.summation.sum = kernel(0.0);
}

fn summation_pair(own: Own, other: Neighbor, density: ptr<function, Density>) {
    density.summation.sum += other.share * kernel(other.r);
}

fn summation_end(own: Own, density: ptr<function, Density>) {
    density.deviation = fluid.volume * density.summation.sum - 1.0;
}
