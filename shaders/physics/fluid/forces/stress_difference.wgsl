// 1/ρᵢ Σ Vⱼ (τⱼ − τᵢ) B ∇W with the viscous stress τ (Rojas 2013, Eq. 4), for corrected gradients. A wall's stress is that
// of the fluid beside it.
var<storage, read> stress: array<Matrix>;

fn stress_difference_pair(own: Own, other: Neighbor, forces: ptr<function, Forces>) {
    let mine = stress[own.index] * other.s;
    forces.drag -= other.weight * select(stress[other.index] * other.s - mine, Vector(0.0), other.wall);
}

fn stress_difference_end(own: Own, forces: ptr<function, Forces>) {
    forces.drag = corrected(own.index, forces.drag);
}
