// What moves note of the particles, in one buffer: accidents; what the length of the next step depends on; whether lists
// still serve. A particle that became non-finite, left a closed domain or ran away is stopped, and the first one's story is
// kept.
#import common/vector

// Bits of numbers that are not negative, which are ordered as the numbers are.
struct Extremes {
    acceleration: atomic<u32>, // the greatest, m/s²
    signal: atomic<u32>, // the greatest sum of a particle's speed and the speed of sound in it, m/s
    sound: atomic<u32>, // the greatest speed of sound, m/s
}

struct Guard {
    lower: vec4f, // m; where a particle counts as lost, far away on open sides
    upper: vec4f, // w: square of a speed, m²/s²; what is faster has run away
    position: vec4f, // of the first particle caught, m
    velocity: vec4f, // m/s
    id: u32, // of that particle; its slot, until advance_clock.wgsl looks up the id
    step: u32, // advance_clock.wgsl sets it
    kind: u32, // GUARD_NOT_FINITE, GUARD_LOST, GUARD_RAN_AWAY or GUARD_CROWDED
    count: atomic<u32>, // catches in all
    extremes: Extremes, // of the step
    far: atomic<u32>, // not zero: a particle has moved so far that a neighbor may be missing from a list
}

var<storage, read_write> guard: Guard;

// By its bits: arithmetic on a NaN may be optimized away.
fn is_finite(v: Vector) -> bool {
    let exponent = bitcast<vec4u>(vec4f(to_3d(v), 0.0)) & vec4u(0x7f800000u);
    return all(exponent != vec4u(0x7f800000u));
}

// `moved` and `velocity` are what the step wants; on an accident the particle stays where it was, at rest.
fn watch(slot: u32, before: Vector, moved: ptr<function, Vector>, velocity: ptr<function, Vector>) {
    let finite = is_finite(*moved) && is_finite(*velocity);
    let within = all(*moved >= first(guard.lower)) && all(*moved <= first(guard.upper));
    let flows = dot(*velocity, *velocity) <= guard.upper.w;
    if finite && within && flows {
        return;
    }
    if atomicAdd(&guard.count, 1u) == 0u {
        guard.id = slot;
        guard.kind = select(select(GUARD_RAN_AWAY, GUARD_LOST, !within), GUARD_NOT_FINITE, !finite);
        guard.position = vec4f(to_3d(before), 0.0);
        guard.velocity = vec4f(to_3d(*velocity), 0.0);
    }
    *moved = before;
    *velocity = Vector(0.0);
}
