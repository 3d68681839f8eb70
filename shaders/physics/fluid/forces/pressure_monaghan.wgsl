// −Σ mⱼ (pᵢ/ρᵢ² + pⱼ/ρⱼ²) ∇W (Monaghan 1992).

fn pressure_monaghan_pair(own: Own, other: Neighbor, forces: ptr<function, Forces>) {
    let ratio = other.material.density * (1.0 + other.deviation) / own.density;
    forces.push += (other.weight * (own.pressure * ratio + other.pressure / ratio)) * other.s;
}
