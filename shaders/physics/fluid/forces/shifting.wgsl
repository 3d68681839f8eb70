// Particle shifting: from where particles crowd to where they are sparse (Lind 2012; Sun 2017). Velocity and density follow
// along their slopes.

struct Shifting {
    crowd: Vector, // gradient of concentration, 1/m
    excess_slope: Vector, // of density along the way, 1/m
    way: Vector, // m
}

// More where particles come close, so that they do not pair (Monaghan 2000).
fn shifting_pair(own: Own, other: Neighbor, forces: ptr<function, Forces>) {
    let near = kernel(other.r) / fluid.kernel_at_spacing;
    forces.shifting.crowd -= (other.weight * (1.0 + 0.2 * (near * near) * (near * near))) * other.s;
    forces.shifting.excess_slope -= (other.weight * (other.excess - own.excess)) * other.s;
}

fn shifting_end(own: Own, forces: ptr<function, Forces>) {
    forces.shifting.excess_slope = corrected(own.index, forces.shifting.excess_slope);
    let wanted = -(time_step() * fluid.shifting) * forces.shifting.crowd;
    forces.shifting.way = wanted * min(1.0, fluid.shift_limit / max(length(wanted), 1e-30));
}
