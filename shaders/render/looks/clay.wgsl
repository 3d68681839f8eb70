// Lumps of clay: dents as fingers leave them, and a color that varies a little.

#import render/looks/matte

const DENT: f32 = 0.3; // slope
const MOTTLE: f32 = 0.05; // share of the albedo

fn own_surface(grain: Grain, albedo: vec3f, normal: vec3f) -> Matte {
    let at = turned_back(grain.turn, normal);
    // Waves that bend each other, so that dents do not lie in rows.
    let bend = at + 0.35 * sin(3.1 * at.yzx + 2.0 * grain.turn.xyz) + 0.15 * sin(7.3 * at.zxy);
    let rise = cos(4.7 * bend.yzx) + 0.5 * cos(9.1 * bend.zxy + 1.0);
    let along = turned(grain.turn, rise - dot(rise, at) * at);
    let mottle = sin(11.0 * bend.x) * sin(9.0 * bend.y) + sin(10.0 * bend.z) * sin(23.0 * bend.y);
    return Matte(
        albedo * (1.0 + MOTTLE * grain.detail * mottle),
        normalize(normal - DENT * grain.detail * along),
    );
}
