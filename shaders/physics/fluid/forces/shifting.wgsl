// Particle shifting: from where particles crowd to where they are sparse (Lind 2012; Sun 2017). Velocity and density follow
// along their slopes.

struct Shifting {
    crowd: Vector, // gradient of concentration, 1/m
    deviation_slope: Vector, // of ρ/ρ₀, 1/m
    displacement: Vector, // m
}

// More where particles come close, so that they do not pair (Monaghan 2000).
fn shifting_pair(own: Own, other: Neighbor, forces: ptr<function, Forces>) {
    let near = kernel(other.r) / fluid.kernel_at_spacing;
    forces.shifting.crowd -= (other.weight * (1.0 + 0.2 * (near * near) * (near * near))) * other.s;
    forces.shifting.deviation_slope -= (other.weight * (other.deviation - own.deviation)) * other.s;
}

fn shifting_end(own: Own, forces: ptr<function, Forces>) {
    forces.shifting.deviation_slope = corrected(own.index, forces.shifting.deviation_slope);
    let wanted = -(time_step() * fluid.shifting) * forces.shifting.crowd;
    forces.shifting.displacement = wanted * min(1.0, fluid.shift_limit / max(length(wanted), 1e-30));
}
