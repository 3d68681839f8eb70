// Catches a particle that became non-finite, left a closed domain or ran away, stops it, and keeps the first one's story.
#import common/vector

struct Guard {
    lower: vec4f, // m; where a particle counts as lost, far away on open sides
    upper: vec4f, // w: square of a speed, m²/s²; what is faster has run away
    position: vec4f, // of the first particle caught, m
    velocity: vec4f, // m/s
    id: u32,
    step: u32, // advance_clock.wgsl sets it
    kind: u32, // GUARD_NOT_FINITE, GUARD_LOST or GUARD_RAN_AWAY
    count: atomic<u32>, // catches in all
}

var<storage, read_write> guard: Guard;

// By its bits: arithmetic on a NaN may be optimized away.
fn is_finite(v: Vector) -> bool {
    let exponent = bitcast<vec4u>(vec4f(to_3d(v), 0.0)) & vec4u(0x7f800000u);
    return all(exponent != vec4u(0x7f800000u));
}

// `moved` and `velocity` are what the step wants; on an accident the particle stays where it was, at rest.
fn watch(particle: u32, before: Vector, moved: ptr<function, Vector>, velocity: ptr<function, Vector>) {
    let finite = is_finite(*moved) && is_finite(*velocity);
    let within = all(*moved >= first(guard.lower)) && all(*moved <= first(guard.upper));
    let flows = dot(*velocity, *velocity) <= guard.upper.w;
    if finite && within && flows {
        return;
    }
    if atomicAdd(&guard.count, 1u) == 0u {
        guard.id = particle;
        guard.kind = select(select(GUARD_LOST, GUARD_RAN_AWAY, !flows), GUARD_NOT_FINITE, !finite);
        guard.position = vec4f(to_3d(before), 0.0);
        guard.velocity = vec4f(to_3d(*velocity), 0.0);
    }
    *moved = before;
    *velocity = Vector(0.0);
}
