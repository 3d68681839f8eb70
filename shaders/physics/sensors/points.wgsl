// Probes of a fluid between its particles: a field at a point, and how high the surface is on a line. Candidates come from
// the voxels, since lists belong to particles.
#import common/thread
#import common/reach
#import cells/images
#import storage/from_voxels
#import physics/fluid/coefficients
#import physics/fluid/matrix
#import physics/fluid/boundary_particles
#import <kernel>
#import physics/sensors/field
#import physics/sensors/probe

// In the order of the probes.
var<storage, read_write> point_readings: array<Reading>;
// Number of the highest point of the line that is inside of the fluid, counted from 1; 0 where none is.
var<workgroup> highest: atomic<u32>;

// Points of a line per spacing of particles.
const POINTS_PER_SPACING: f32 = 4.0;
const BISECTIONS: u32 = 16u;

// Sum of the particles' volumes at rest times the kernel: about 1 inside of the fluid, ½ on its surface, 0 outside.
fn filling(x: Vector) -> f32 {
    var sum = 0.0;
    for (var number = 0u; number < IMAGES; number++) {
        var seen = x;
        if !image(x, number, fluid.support, &seen) {
            continue;
        }
        let home = voxel_of(seen);
        for (var k = 0u; k < RANGES; k++) {
            let range = candidate_range(home, k);
            for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
                let j = candidate(slot);
                let s = unpack(position[j]) - seen;
                if within(s, fluid.support) && !is_boundary(j) {
                    sum += kernel(length(s));
                }
            }
        }
    }
    return sum * fluid.volume;
}

// The kernel's mean of the particles around (Shepard 1968), corrected so that it is exact for fields that are linear in
// space; where particles do not spread enough for that, the mean itself.
fn interpolate(probe: Probe) -> Reading {
    let x = first(probe.lower);
    var weights = 0.0;
    var offsets = Vector(0.0); // in units of the support, as all lengths here
    var spread = Matrix();
    var values = vec3f(0.0);
    var value_offsets = array<Vector, 3>(Vector(0.0), Vector(0.0), Vector(0.0));
    for (var number = 0u; number < IMAGES; number++) {
        var seen = x;
        if !image(x, number, fluid.support, &seen) {
            continue;
        }
        let home = voxel_of(seen);
        for (var k = 0u; k < RANGES; k++) {
            let range = candidate_range(home, k);
            for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
                let j = candidate(slot);
                let s = unpack(position[j]) - seen;
                if within(s, fluid.support) && !is_boundary(j) {
                    let weight = kernel(length(s)) * fluid.volume;
                    let offset = s / fluid.support;
                    let value = field_of(j, probe.field);
                    weights += weight;
                    offsets += weight * offset;
                    spread += weight * outer(offset, offset);
                    values += weight * value;
                    for (var axis = 0u; axis < 3u; axis++) {
                        value_offsets[axis] += (weight * value[axis]) * offset;
                    }
                }
            }
        }
    }
    if weights <= 0.0 {
        return Reading(vec4f(0.0), vec4f(0.0));
    }
    var mean = values / weights;
    let middle = offsets / weights;
    let around_middle = spread * (1.0 / weights) - outer(middle, middle);
    if weights > probe.least_filling && determinant(around_middle) > probe.threshold {
        let exact = inverse(around_middle);
        let before = mean;
        for (var axis = 0u; axis < 3u; axis++) {
            let slope = exact * (value_offsets[axis] / weights - before[axis] * middle);
            mean[axis] = before[axis] - dot(slope, middle);
        }
    }
    return Reading(vec4f(mean, weights), vec4f(0.0));
}

// One workgroup for each probe.
@compute @workgroup_size(GROUP_SIZE)
fn sense_points(thread: Thread) {
    let number = min(group_index(thread), POINT_PROBES - 1u);
    let probe = probes[FIRST_POINT_PROBE + number];
    let offset = first(probe.upper) - first(probe.lower);
    let is_height = probe.kind == PROBE_HEIGHT;
    let points = select(0u, u32(ceil(length(offset) / fluid.spacing * POINTS_PER_SPACING)) + 1u, is_height);
    let step = offset / f32(max(points, 2u) - 1u);
    if thread.local_index == 0u {
        atomicStore(&highest, 0u);
    }
    workgroupBarrier();
    for (var point = thread.local_index; point < points; point += GROUP_SIZE) {
        if filling(first(probe.lower) + f32(point) * step) > probe.threshold {
            atomicMax(&highest, point + 1u);
        }
    }
    workgroupBarrier();
    if thread.local_index != 0u {
        return;
    }
    if !is_height {
        point_readings[number] = interpolate(probe);
        return;
    }
    let found = atomicLoad(&highest);
    var height = f32(found) - 1.0; // in steps
    if found > 0u && found < points {
        // The surface lies between this point and the next one.
        for (var bisection = 1u; bisection <= BISECTIONS; bisection++) {
            let higher = height + exp2(-f32(bisection));
            if filling(first(probe.lower) + higher * step) > probe.threshold {
                height = higher;
            }
        }
    }
    point_readings[number] = Reading(vec4f(max(height, 0.0) * length(step), 0.0, 0.0, 0.0), vec4f(0.0));
}
