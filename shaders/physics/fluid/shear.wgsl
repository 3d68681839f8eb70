// Twice the viscosity between two particles, Pa·s: none at walls along which fluid slips.

fn shear_between(own: Own, other: Neighbor) -> f32 {
    return select(own.material.viscosity + other.material.viscosity, 0.0, SLIPS & other.wall);
}
