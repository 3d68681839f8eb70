// Sides of the domain that are planes: beyond them the fluid goes on as far as the kernel reaches, its pressure along
// gravity and its velocity along a straight line (Rojas 2013; Morris 1997). The integrals of the kernel over what lies
// beyond, edges and corners included, are sums over the cells of a lattice that begins at the sides (midpoint rule), so
// that nothing beyond has to be kept in memory or searched.
#import common/vector
#import physics/fluid/coefficients

struct Planes {
    lower: vec4f, // sides that are planes, m; far away where there is none
    upper: vec4f,
    x_min: vec4f, // velocities of the sides' surfaces, m/s
    x_max: vec4f,
    y_min: vec4f,
    y_max: vec4f,
    z_min: vec4f,
    z_max: vec4f,
    anchor: vec4f, // where the lattice begins, m
    spacing: f32, // m
}

var<uniform> planes: Planes;

// A cell beyond the sides.
struct Beyond {
    way: Vector, // from the particle, m
    counts: bool, // whether it lies beyond a side
    velocity: Vector, // of that side, m/s
    stretch: f32, // a velocity that is the particle's at the particle and the side's at the side has changed by so many
                  // times their difference there
}

#if two_dimensional
const BEYOND: u32 = PLANE_CELLS * PLANE_CELLS;
#else
const BEYOND: u32 = PLANE_CELLS * PLANE_CELLS * PLANE_CELLS;
#end

// Whether the kernel reaches beyond a side.
fn near_planes(x: Vector) -> bool {
    let inside = min(x - first(planes.lower), first(planes.upper) - x);
    return any(inside < Vector(fluid.support));
}

fn beyond(x: Vector, number: u32) -> Beyond {
    let cells = vec3u(number % PLANE_CELLS, number / PLANE_CELLS % PLANE_CELLS, number / (PLANE_CELLS * PLANE_CELLS));
    let reach = f32(PLANE_CELLS / 2u);
    let offset = first(vec4f(vec3f(cells) - reach, 0.0));
    let home = floor((x - first(planes.anchor)) / planes.spacing);
    let point = first(planes.anchor) + (home + offset + 0.5) * planes.spacing;
    let below = first(planes.lower) - point;
    let above = point - first(planes.upper);
    let out = max(below, above);
    // The side that it is farthest beyond.
    var axis = 0u;
    for (var other = 1u; other < DIMENSIONS; other++) {
        axis = select(axis, other, out[other] > out[axis]);
    }
    let low = below[axis] > 0.0;
    let inside = select(planes.upper[axis] - x[axis], x[axis] - planes.lower[axis], low);
    var velocity = select(planes.x_max, planes.x_min, low);
    if axis == 1u {
        velocity = select(planes.y_max, planes.y_min, low);
    }
    if axis == 2u {
        velocity = select(planes.z_max, planes.z_min, low);
    }
    let stretch = 1.0 + out[axis] / max(inside, 0.25 * planes.spacing);
    return Beyond(point - x, out[axis] > 0.0, first(velocity), stretch);
}
