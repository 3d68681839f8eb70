// Particles of rigid bodies.

struct Member {
    place: vec4f, // in its body, from the center of mass along the body's own axes, m
    body: u32, // number, from 0 on
    slot: u32, // where it stands behind the last search
    inverse_mass: f32, // of the body, 1/kg
    overlaps: f32, // sum over the contacts of the body, m
}
