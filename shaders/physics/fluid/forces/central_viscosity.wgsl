// 1/ρᵢ Σ Vⱼ (d + 2) (μᵢ + μⱼ) ((vⱼ − vᵢ)·s / r²) ∇W in d dimensions (Monaghan and Gingold 1983): forces between two particles
// act along the line that joins them, so angular momentum stays, and a free surface dissipates as it must (Colagrossi 2011).
#import physics/fluid/shear

fn central_viscosity_pair(own: Own, other: Neighbor, forces: ptr<function, Forces>) {
    let approach = dot(other.viscous - own.velocity, other.s) / max(dot(other.s, other.s), fluid.smallest_square);
    let strength = shear_between(own, other) * other.weight * other.stretch;
    forces.drag -= (f32(DIMENSIONS + 2u) * strength * approach) * other.s;
}
