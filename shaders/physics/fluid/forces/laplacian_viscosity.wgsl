// 1/ρᵢ Σ Vⱼ (μᵢ + μⱼ) (1/r) dW/dr (vᵢ − vⱼ): differences of velocities along pairs (Morris 1997).
#import physics/fluid/shear

fn laplacian_viscosity_pair(own: Own, other: Neighbor, forces: ptr<function, Forces>) {
    forces.drag -= (shear_between(own, other) * other.weight * other.stretch) * (other.viscous - own.velocity);
}
