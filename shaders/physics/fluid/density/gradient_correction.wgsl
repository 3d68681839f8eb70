// The matrix that makes gradients exact for linear fields: the inverse of Σⱼ Vⱼ s ⊗ ∇W (Randles and Libersky 1996).
#import physics/fluid/matrix
var<storage, read_write> correction: array<Matrix>;

// Below this determinant a particle has too few neighbors for its gradients to be corrected.
const FEW_NEIGHBORS: f32 = 0.3;

struct GradientCorrection {
    moment: Matrix,
    exact: Matrix, // its inverse
}

fn gradient_correction_pair(own: Own, other: Neighbor, density: ptr<function, Density>) {
    density.gradient_correction.moment -= other.weight * outer(other.s, other.s);
}

fn gradient_correction_end(own: Own, density: ptr<function, Density>) {
    let moment = density.gradient_correction.moment;
    var exact = unit();
    if determinant(moment) > FEW_NEIGHBORS {
        exact = inverse(moment);
    }
    density.gradient_correction.exact = exact;
    correction[own.index] = exact;
}
