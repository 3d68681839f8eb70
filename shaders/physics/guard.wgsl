// What moves note of the particles, in one buffer: accidents; what the length of the next step depends on; whether lists
// still serve. A particle that became non-finite, left a closed domain or ran away is stopped. Of the accidents of the first
// step that has any, the same one is told in every run, whichever thread comes first.
#import common/vector
#import common/shuffle

// Bits of numbers that are not negative, which are ordered as the numbers are.
struct Extremes {
    acceleration: atomic<u32>, // the greatest, m/s²
    signal: atomic<u32>, // the greatest sum of a particle's speed and the speed of sound in it, m/s
    sound: atomic<u32>, // the greatest speed of sound, m/s
}

struct Accident {
    position: vec4f, // before the step, m
    velocity: vec4f, // after it, m/s
    id: u32, // its slot, until advance_clock.wgsl looks up the id
    kind: u32, // one of GUARD_… (src/guards.rs)
    order: u32, // the accident with the lowest one is told
}

struct Guard {
    lower: vec4f, // m; where a particle counts as lost, far away on open sides; w: how far that is
    upper: vec4f, // w: square of a speed, m²/s²; what is faster is too fast for a step, or for sound
    runaway: f32, // square of the speed beyond which fluid has run away, m²/s²
    step: u32, // of the first accidents; advance_clock.wgsl sets it
    count: atomic<u32>, // accidents in all
    lowest: atomic<u32>, // order among the first ones
    noted: atomic<u32>,
    extremes: Extremes, // of the step
    far: atomic<u32>, // not zero: a particle has moved so far that a neighbor may be missing from a list
    listed_for: f32, // since lists were made that expect straight paths, s
    accidents: array<Accident, ACCIDENTS>, // those of the first step that were lower than all before them
}

var<storage, read_write> guard: Guard;

// By its bits: arithmetic on a NaN may be optimized away.
fn is_finite(v: Vector) -> bool {
    let exponent = bitcast<vec4u>(vec4f(to_3d(v), 0.0)) & vec4u(0x7f800000u);
    return all(exponent != vec4u(0x7f800000u));
}

fn note_accident(slot: u32, kind: u32, position: Vector, velocity: Vector) {
    atomicAdd(&guard.count, 1u);
    if guard.step != GUARD_NO_STEP {
        return;
    }
    // In whatever order places are caught, few of these numbers are lower than all before. Two in one place are told of as one.
    let bits = bitcast<vec3u>(to_3d(position));
    let order = shuffled(bits.x ^ shuffled(bits.y ^ shuffled(bits.z)));
    if order >= atomicMin(&guard.lowest, order) {
        return;
    }
    let place = atomicAdd(&guard.noted, 1u);
    if place < ACCIDENTS {
        guard.accidents[place].position = vec4f(to_3d(position), 0.0);
        guard.accidents[place].velocity = vec4f(to_3d(velocity), 0.0);
        guard.accidents[place].id = slot;
        guard.accidents[place].kind = kind;
        guard.accidents[place].order = order;
    }
}

// What is wrong with a place beyond the bounds: open sides have theirs where single precision ends.
fn crossed_bound(moved: Vector) -> u32 {
    let edge = guard.lower.w;
    let below = (moved < first(guard.lower)) & (first(guard.lower) > Vector(-edge));
    let above = (moved > first(guard.upper)) & (first(guard.upper) < Vector(edge));
    return select(GUARD_EDGE, GUARD_LOST, any(below | above));
}

// `moved` and `velocity` are what the step wants; on an accident the particle stays where it was, at rest.
fn watch(slot: u32, before: Vector, moved: ptr<function, Vector>, velocity: ptr<function, Vector>) {
#if !unguarded
    let square = dot(*velocity, *velocity);
    let finite = is_finite(*moved) && is_finite(*velocity);
    let within = all(*moved >= first(guard.lower)) && all(*moved <= first(guard.upper));
    if finite && within && square <= guard.upper.w {
        return;
    }
    var kind = select(GUARD_TOO_FAST, GUARD_RUNAWAY, square > guard.runaway);
    if !finite {
        kind = GUARD_NOT_FINITE;
    } else if !within {
        kind = crossed_bound(*moved);
    }
    note_accident(slot, kind, before, *velocity);
    *moved = before;
    *velocity = Vector(0.0);
#end
}
