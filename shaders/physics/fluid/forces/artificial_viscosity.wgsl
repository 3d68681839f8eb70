// Σ Vⱼ α h c min((vⱼ − vᵢ)·s, 0) / (r² + 0.01 h²) ∇W (Monaghan 1992). Walls along which fluid slips are left to
// wall_damping.wgsl.

fn artificial_viscosity_pair(own: Own, other: Neighbor, forces: ptr<function, Forces>) {
    let nearing = min(dot(other.velocity - own.velocity, other.s), 0.0);
    let approach = select(nearing, 0.0, SLIPS & other.wall);
    let square = dot(other.s, other.s) + fluid.smallest_square;
    let strength = other.weight * own.density * fluid.artificial_viscosity * approach / square;
    forces.drag -= strength * other.s;
}
