// A direction; up where there is none.
fn unit_of(v: vec3f) -> vec3f {
    let length = length(v);
    return select(vec3f(0.0, 1.0, 0.0), v / length, length > 0.0);
}
