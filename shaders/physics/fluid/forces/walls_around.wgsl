// What formulas for walls along which fluid slips have in common.

struct WallsAround {
    inwards: Vector, // into the walls around; as long as they have area over volume, 1/m
    against: f32, // how much of them is near, 1/m²
    velocity: Vector, // their sum, weighted alike
}

fn walls_around_pair(own: Own, other: Neighbor, forces: ptr<function, Forces>) {
    let weight = select(0.0, -other.weight, other.wall);
    forces.walls_around.inwards += weight * other.s;
    forces.walls_around.against += weight;
    forces.walls_around.velocity += weight * other.velocity;
}

// How walls go past.
struct Passing {
    area: f32, // over volume, 1/m
    inwards: Vector, // direction
    nearing: f32, // speed against that direction, negative where walls come nearer, m/s
    along: Vector, // velocity along them, m/s
}

fn passing(own: Own, walls: WallsAround) -> Passing {
    let area = length(walls.inwards);
    let inwards = walls.inwards / max(area, 1e-30);
    let past = walls.velocity / max(walls.against, 1e-30) - own.velocity;
    let nearing = dot(past, inwards);
    return Passing(area, inwards, nearing, past - nearing * inwards);
}
