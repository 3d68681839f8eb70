// dρᵢ/dt = −ρᵢ ∇·v with the divergence Σⱼ Vⱼ (vⱼ − vᵢ)·∇W (Monaghan 1994).
#import physics/fluid/mirror

struct Continuity {
    divergence: f32, // of velocity, 1/s
}

fn continuity_pair(own: Own, other: Neighbor, density: ptr<function, Density>) {
    let relative = other.velocity - own.velocity;
    density.continuity.divergence -= (other.weight * mirrored(other)) * dot(relative, other.s);
}

fn continuity_end(own: Own, density: ptr<function, Density>) {
    density.rate -= (1.0 + own.deviation) * density.continuity.divergence;
}
