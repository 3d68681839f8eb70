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
    offset: Vector, // from the particle, m
    share: f32, // 1 where it lies beyond a side, 0 elsewhere
    velocity: Vector, // of that side, m/s
    stretch: f32, // a velocity that is the particle's at the particle and the side's at the side has changed by so many
                  // times their difference there
}

#if two_dimensional
const BEYOND: u32 = PLANE_CELLS * PLANE_CELLS;
#else
const BEYOND: u32 = PLANE_CELLS * PLANE_CELLS * PLANE_CELLS;
#end

// Cells to look at: none where the kernel does not reach beyond a side. (A branch instead, or one in the loop over them,
// crashes the shader compiler of Mesa 22.3's software driver; kernels are zero beyond their reach anyway.)
fn cells_beyond(x: Vector) -> u32 {
    let inside = min(x - first(planes.lower), first(planes.upper) - x);
    return select(0u, BEYOND, any(inside < Vector(fluid.support)));
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
    let low = below > Vector(0.0);
    let inside = select(first(planes.upper) - x, x - first(planes.lower), low);
    // Of the side that it is farthest beyond.
    var velocity = select(first(planes.x_max), first(planes.x_min), low.x);
    var depth = vec2f(out.x, inside.x);
    let further = out.y > depth.x;
    velocity = select(velocity, select(first(planes.y_max), first(planes.y_min), low.y), further);
    depth = select(depth, vec2f(out.y, inside.y), further);
#if !two_dimensional
    let furthest = out.z > depth.x;
    velocity = select(velocity, select(first(planes.z_max), first(planes.z_min), low.z), furthest);
    depth = select(depth, vec2f(out.z, inside.z), furthest);
#end
    let stretch = 1.0 + depth.x / max(depth.y, 0.25 * planes.spacing);
    return Beyond(point - x, select(0.0, 1.0, depth.x > 0.0), velocity, stretch);
}
