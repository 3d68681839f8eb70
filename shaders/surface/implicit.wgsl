// The implicit function of the particles (Zhu and Bridson 2005, Section 5): the distance of a point from the weighted mean of
// the particles around it, less a radius. It is negative inside.
//
// Two things are added. No point of the surface is farther than `farthest` from a particle, and less far where there are few:
// between two drops the mean would else be a third one. And at a side of the domain the particles are mirrored, so that the surface meets it straight, and what
// lies beyond is cut off.
#import common/vector
#import physics/present
#import physics/fluid/boundary_particles
#import <candidates>
#import surface/surface

// The particles around a point, whose places count from it.
struct Around {
    weight: f32, // sum
    mean: vec3f, // weighted, m
    nearest: f32, // m
    outward: vec3f, // away from the mean by weights that fall off slowly, m: for normals
}

const NOBODY_NEAR: f32 = 1e18;

// The side of the domain that is nearer, along each axis.
fn nearer_side(x: vec3f) -> vec3f {
    return select(surface.high.xyz, surface.low.xyz, x - surface.low.xyz < surface.high.xyz - x);
}

fn around_point(x: vec3f) -> Around {
    var sum = Around(0.0, vec3f(0.0), NOBODY_NEAR, vec3f(0.0));
    let side = nearer_side(x);
    let is_near = abs(x - side) < vec3f(surface.reach);
    let square = surface.reach * surface.reach;
    for (var image = 0u; image < 8u; image++) {
        let mirrored = (vec3u(image) & vec3u(1u, 2u, 4u)) != vec3u(0u);
        if any(mirrored & !is_near) {
            continue;
        }
        let at = select(x, 2.0 * side - x, mirrored);
        let direction = select(vec3f(1.0), vec3f(-1.0), mirrored);
        let home = voxel_of(at);
        for (var k = 0u; k < RANGES; k++) {
            let range = candidate_range(home, k);
            for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
                let j = candidate(slot);
                let y = direction * (unpack(position[j]) - at);
                let distance = dot(y, y);
                if distance >= square || is_boundary(j) {
                    continue;
                }
                let share = 1.0 - distance / square;
                let weight = share * share * share;
                sum.weight += weight;
                sum.mean += weight * y;
                sum.outward -= share * y;
                sum.nearest = min(sum.nearest, distance);
            }
        }
    }
    sum.nearest = sqrt(sum.nearest);
    if sum.weight > 0.0 {
        sum.mean /= sum.weight;
    }
    return sum;
}

// Sums of weights around a drop and above a surface, and how far from a drop its surface may be, as a share.
const FEW: f32 = 1.0;
const MANY: f32 = 4.0;
const FARTHEST_ALONE: f32 = 0.67;

// 0 around a drop, 1 where there are as many particles as at a surface.
fn crowd(around: Around) -> f32 {
    return saturate((around.weight - FEW) / (MANY - FEW));
}

// Of the particles alone, m.
fn of_particles(around: Around) -> f32 {
    if around.weight <= 0.0 {
        return surface.reach;
    }
    let farthest = surface.farthest * mix(FARTHEST_ALONE, 1.0, crowd(around));
    return max(length(around.mean) - surface.radius, around.nearest - farthest);
}

// How far a point is beyond the sides of the domain, m; negative inside.
fn beyond_sides(x: vec3f) -> f32 {
    let beyond = max(surface.low.xyz - x, x - surface.high.xyz);
    return max(max(beyond.x, beyond.y), beyond.z);
}
