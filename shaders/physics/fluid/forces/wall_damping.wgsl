// Artificial viscosity at walls along which fluid slips: they damp what comes nearer and leave alone what goes along them.

struct WallDamping {
    damping: Matrix,
}

fn wall_damping_pair(own: Own, other: Neighbor, forces: ptr<function, Forces>) {
    let weight = select(0.0, -other.weight, other.wall);
    let square = dot(other.s, other.s) + fluid.smallest_square;
    forces.wall_damping.damping += (weight / square) * outer(other.s, other.s);
}

fn wall_damping_end(own: Own, forces: ptr<function, Forces>) {
    let walls = passing(own, forces.walls_around);
    let share = dot(walls.inwards, forces.wall_damping.damping * walls.inwards);
    let strength = own.density * fluid.artificial_viscosity * min(walls.nearing, 0.0) * share;
    forces.drag += strength * walls.inwards;
}
