// Square matrices of the scene's dimensions.
#import common/vector

#if two_dimensional
alias Matrix = mat2x2f;

fn outer(a: Vector, b: Vector) -> Matrix {
    return Matrix(a * b.x, a * b.y);
}

fn unit() -> Matrix {
    return Matrix(1.0, 0.0, 0.0, 1.0);
}

fn inverse(m: Matrix) -> Matrix {
    return Matrix(m[1].y, -m[0].y, -m[1].x, m[0].x) * (1.0 / determinant(m));
}

fn trace(m: Matrix) -> f32 {
    return m[0].x + m[1].y;
}
#else
alias Matrix = mat3x3f;

fn outer(a: Vector, b: Vector) -> Matrix {
    return Matrix(a * b.x, a * b.y, a * b.z);
}

fn unit() -> Matrix {
    return Matrix(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
}

fn inverse(m: Matrix) -> Matrix {
    let cofactors = Matrix(cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1]));
    return transpose(cofactors) * (1.0 / determinant(m));
}

fn trace(m: Matrix) -> f32 {
    return m[0].x + m[1].y + m[2].z;
}
#end
