// Correction of gradients, which makes them exact for linear fields (Randles and Libersky 1996), where a scene wants it.
#import physics/fluid/matrix

#if gradient_correction
var<storage, read> correction: array<Matrix>;

fn corrected(i: u32, gradient: Vector) -> Vector {
    return correction[i] * gradient;
}

fn corrected_matrix(i: u32, gradient: Matrix) -> Matrix {
    return gradient * correction[i];
}
#else
fn corrected(i: u32, gradient: Vector) -> Vector {
    return gradient;
}

fn corrected_matrix(i: u32, gradient: Matrix) -> Matrix {
    return gradient;
}
#end
