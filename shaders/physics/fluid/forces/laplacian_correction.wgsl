// The Laplacian's sum is exact for lattices; else it holds a part of the velocity's slope, and its weights do not add up
// (Schwaiger 2008).
#import physics/fluid/shear

struct LaplacianCorrection {
    offset: Vector, // where the weights of viscous forces are not balanced
}

fn laplacian_correction_pair(own: Own, other: Neighbor, forces: ptr<function, Forces>) {
    forces.laplacian_correction.offset -= (shear_between(own, other) * other.weight) * other.s;
}

fn laplacian_correction_end(own: Own, forces: ptr<function, Forces>) {
    let slope = forces.velocity_gradient.slope;
    let share = trace(correction[own.index]) / f32(DIMENSIONS);
    forces.drag = share * (forces.drag - slope * forces.laplacian_correction.offset);
}
