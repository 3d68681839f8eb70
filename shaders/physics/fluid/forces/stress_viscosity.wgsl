// 1/ρᵢ Σ Vⱼ (τᵢ + τⱼ) ∇W with the viscous stress τ (Rojas 2013, Eq. 4). A wall's stress is that of the fluid beside it.
var<storage, read> stress: array<Matrix>;

fn stress_viscosity_pair(own: Own, other: Neighbor, forces: ptr<function, Forces>) {
    let mine = stress[own.index] * other.s;
    forces.drag -= other.weight * (mine + select(stress[other.index] * other.s, mine, other.wall));
}
