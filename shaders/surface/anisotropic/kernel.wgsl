// A kernel that is an ellipsoid (Yu and Turk 2013, Section 3): a particle at r adds det(G) W(|G (r - center)|). Lengths are
// spacings; W is (1 - q²)³ 315 / 64π, whose integral is 1.

struct Symmetric {
    diagonal: vec3f,
    beside: vec3f, // yz, xz, xy
}

fn applied(m: Symmetric, v: vec3f) -> vec3f {
    return m.diagonal * v + m.beside.zxy * v.yzx + m.beside.yzx * v.zxy;
}

// The minors: the inverse times the determinant.
fn minors(m: Symmetric) -> Symmetric {
    return Symmetric(
        m.diagonal.yzx * m.diagonal.zxy - m.beside * m.beside,
        m.beside.yzx * m.beside.zxy - m.diagonal * m.beside,
    );
}

fn determinant_of(m: Symmetric) -> f32 {
    let by = minors(m);
    return m.diagonal.x * by.diagonal.x + m.beside.z * by.beside.z + m.beside.y * by.beside.y;
}

const BALL: f32 = 1.566681; // 315 / 64π
