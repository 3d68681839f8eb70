// −1/ρᵢ Σ Vⱼ (pⱼ − pᵢ) B ∇W: exact for even pressure, but forces of a pair do not cancel.

fn pressure_difference_pair(own: Own, other: Neighbor, forces: ptr<function, Forces>) {
    forces.push += (other.weight * (other.pressure - own.pressure)) * other.s;
}

fn pressure_difference_end(own: Own, forces: ptr<function, Forces>) {
    forces.push = corrected(own.index, forces.push);
}
