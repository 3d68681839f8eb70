// A stress of ½ c ρ v² on the walls' area (Darcy and Weisbach), half of which the kernels of the particles beside it see.

fn wall_friction_end(own: Own, forces: ptr<function, Forces>) {
    let walls = passing(own, forces.walls_around);
    forces.drag += (own.density * fluid.wall_friction * walls.area * length(walls.along)) * walls.along;
}
