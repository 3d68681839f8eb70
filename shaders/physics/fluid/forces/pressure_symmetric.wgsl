// −1/ρᵢ Σ Vⱼ (pᵢ + pⱼ) ∇W (Rojas 2013), stable between fluids of different density.

fn pressure_symmetric_pair(own: Own, other: Neighbor, forces: ptr<function, Forces>) {
    forces.push += (other.weight * (other.pressure + own.pressure)) * other.s;
}
