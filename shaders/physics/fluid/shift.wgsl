// Particle shifting beside a free surface: along it only, and not at all for what has left the fluid (Lind 2012; Sun 2017).
#import common/vector

// Shares of a particle's neighborhood that are there: what counts as the surface, and as a drop, from wholly to not.
const SURFACE = vec2f(0.8, 0.95);
const DROP = vec2f(0.3, 0.4);

fn ramp(ends: vec2f, value: f32) -> f32 {
    return clamp((value - ends.x) / (ends.y - ends.x), 0.0, 1.0);
}

// `crowd`: where particles are denser; `inside`: away from the surface; `surrounded`: divergence of positions.
fn along_surface(crowd: Vector, inside: Vector, surrounded: f32) -> Vector {
    let share = surrounded / f32(DIMENSIONS);
    let normal = inside / max(length(inside), 1e-30);
    let through = (1.0 - ramp(SURFACE, share)) * dot(crowd, normal);
    return ramp(DROP, share) * (crowd - through * normal);
}
