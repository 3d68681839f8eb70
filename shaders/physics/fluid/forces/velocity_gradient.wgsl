// How velocity changes around the particle; walls along which fluid slips say nothing of it.

struct VelocityGradient {
    slope: Matrix, // 1/s
}

fn velocity_gradient_pair(own: Own, other: Neighbor, forces: ptr<function, Forces>) {
    let weight = select(other.weight, 0.0, SLIPS & other.wall);
    forces.velocity_gradient.slope -= (weight * other.stretch) * outer(other.viscous - own.velocity, other.s);
}

fn velocity_gradient_end(own: Own, forces: ptr<function, Forces>) {
    forces.velocity_gradient.slope = corrected_matrix(own.index, forces.velocity_gradient.slope);
}
