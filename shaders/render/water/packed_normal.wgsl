// A unit vector in 32 bits: its place on an octahedron (Cigolle et al. 2014).

fn folded(v: vec2f) -> vec2f {
    return (1.0 - abs(v.yx)) * select(vec2f(-1.0), vec2f(1.0), v >= vec2f(0.0));
}

fn pack_normal(n: vec3f) -> u32 {
    let place = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    return pack2x16snorm(select(folded(place), place, n.z >= 0.0));
}

fn unpack_normal(packed: u32) -> vec3f {
    let place = unpack2x16snorm(packed);
    let z = 1.0 - abs(place.x) - abs(place.y);
    return normalize(vec3f(select(folded(place), place, z >= 0.0), z));
}
