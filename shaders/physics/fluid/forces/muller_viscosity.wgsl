// 1/ρᵢ Σ Vⱼ ½ (μᵢ + μⱼ) ∇²W (vⱼ − vᵢ), with a kernel of its own (Müller 2003).
#import physics/fluid/shear

fn muller_viscosity_pair(own: Own, other: Neighbor, forces: ptr<function, Forces>) {
    let shear = 0.5 * shear_between(own, other);
    forces.drag += (shear * other.volume * kernel_laplacian(other.r) * other.stretch) * (other.viscous - own.velocity);
}
