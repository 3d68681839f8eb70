// What sensors look at. A sensor is one probe, and a profile has one for each layer.
#import common/vector

struct Probe {
    kind: u32, // one of the constants PROBE_…
    field: u32, // one of the constants FIELD_…
    target_body: u32, // of a force: the obstacle's number, or SIDE_TARGETS + 2 × axis + end of a side
    threshold: f32, // of a height: filling at the surface; of a point: least spread of particles for the correction
    lower: vec4f, // corner of a box; a point; where a line begins, m. Of a force: the domain
    upper: vec4f, // opposite corner; where a line ends, m
    direction: vec4f, // of a flux: its normal, and in w where the rectangle is along it. Of a force: torques are about it, m
    reach: f32, // of a flux: how far from the rectangle particles count, m
    volume: f32, // of a particle at rest, m³ (m² in 2D)
    density: f32, // at rest, kg/m³
    least_filling: f32, // of a point: share of the kernel that must be filled for the correction
}

// What a probe finds. Both have the meaning that the kind gives them:
// flux: a.x volume per second, a.y mass per second
// mean: a.xyz sum of the values, a.w number of particles
// extremes: a.xyz lowest values, b.xyz highest values, a.w number of particles
// force: a.xyz force, b.xyz torque
// point: a.xyz value, a.w share of the kernel that is filled
// height: a.x height
struct Reading {
    a: vec4f,
    b: vec4f,
}

const LARGEST: f32 = 3.0e38;

fn no_reading(kind: u32) -> Reading {
    if kind == PROBE_EXTREMES {
        return Reading(vec4f(vec3f(LARGEST), 0.0), vec4f(vec3f(-LARGEST), 0.0));
    }
    return Reading(vec4f(0.0), vec4f(0.0));
}

fn add_readings(kind: u32, x: Reading, y: Reading) -> Reading {
    if kind == PROBE_EXTREMES {
        return Reading(vec4f(min(x.a.xyz, y.a.xyz), x.a.w + y.a.w), max(x.b, y.b));
    }
    return Reading(x.a + y.a, x.b + y.b);
}

var<storage, read> probes: array<Probe>;
