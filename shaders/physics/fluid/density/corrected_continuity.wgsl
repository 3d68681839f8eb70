// dρᵢ/dt = −ρᵢ ∇·v with the divergence as the trace of the corrected gradient of velocity.
#import physics/fluid/mirror

struct CorrectedContinuity {
    slopes: Matrix, // of velocity, 1/s
}

fn corrected_continuity_pair(own: Own, other: Neighbor, density: ptr<function, Density>) {
    let relative = other.velocity - own.velocity;
    density.corrected_continuity.slopes -= (other.weight * mirrored(other)) * outer(relative, other.s);
}

fn corrected_continuity_end(own: Own, density: ptr<function, Density>) {
    let divergence = trace(density.corrected_continuity.slopes * density.gradient_correction.exact);
    density.rate -= (1.0 + own.deviation) * divergence;
}
