// Grains of sand: broken faces with rounded edges, and specks of darker minerals.

#import render/looks/matte

const FLATNESS: f32 = 0.6; // of the faces, from 0 to 1
const IRREGULAR: f32 = 0.45;
// Shares of the albedo.
const SPECK: f32 = 0.32;
const VEIN: f32 = 0.16;

// The nearest of the twelve directions in which a dodecahedron has faces.
fn face_of(v: vec3f) -> vec3f {
    let a = abs(v);
    let first = 0.5257311 * a.y + 0.8506508 * a.z;
    let second = 0.5257311 * a.x + 0.8506508 * a.y;
    let third = 0.5257311 * a.z + 0.8506508 * a.x;
    var face = vec3f(0.0, 0.5257311, 0.8506508);
    if second > max(first, third) {
        face = vec3f(0.5257311, 0.8506508, 0.0);
    } else if third > first {
        face = vec3f(0.8506508, 0.0, 0.5257311);
    }
    return select(face, -face, v < vec3f(0.0));
}

fn own_surface(grain: Grain, albedo: vec3f, normal: vec3f) -> Matte {
    let at = turned_back(grain.turn, normal);
    let face = face_of(at + IRREGULAR * grain.turn.yzw);
    let flat_face = turned(grain.turn, face);
    // Waves across each other: where most of them meet there is a speck.
    let fine = 2.3 * at;
    let waves = sin(vec3f(9.1, 7.3, 8.2) * fine + sin(vec3f(5.3, 6.7, 4.1) * fine.yzx + grain.turn.xyz * 3.0));
    let speck = smoothstep(1.5, 2.4, waves.x + waves.y + waves.z);
    let veins = 0.5 * sin(dot(vec3f(4.1, -2.3, 3.2), at) + 2.0 * waves.x);
    return Matte(
        albedo * (1.0 + grain.detail * (VEIN * veins - SPECK * speck)),
        normalize(mix(normal, flat_face, FLATNESS * grain.detail)),
    );
}
