// Images of a point where space repeats.
#import common/vector
#import cells/grid

#if periodic
// The shortest of the separations that differ by periods.
fn nearest_image(separation: Vector) -> Vector {
    return separation - first(grid.period) * round(separation * first(grid.inverse_period));
}

// Back into the domain.
fn wrapped(x: Vector) -> Vector {
    return x - first(grid.period) * floor((x - first(grid.period_lower)) * first(grid.inverse_period));
}

#if two_dimensional
const IMAGES: u32 = 9u;
#else
const IMAGES: u32 = 27u;
#end

// Whether an image of x, which it writes to y, can have neighbors within `reach`. Image 0 is x itself.
fn image(x: Vector, number: u32, reach: f32, y: ptr<function, Vector>) -> bool {
    // Digits 0, 1, 2 of the number stand for 0, 1 and −1 periods.
    let digits = vec3u(number % 3u, number / 3u % 3u, number / 9u);
    let shift = first(vec4f(vec3f(digits) - 3.0 * vec3f(digits / vec3u(2u)), 0.0));
    *y = x + shift * first(grid.period);
    let lower = first(grid.period_lower) - reach;
    let upper = first(grid.period_lower) + first(grid.period) + reach;
    let near = (*y > lower) & (*y < upper);
    let stays = shift == Vector(0.0);
    return all(stays | (near & (first(grid.period) > Vector(0.0))));
}
#else
fn nearest_image(separation: Vector) -> Vector {
    return separation;
}

fn wrapped(x: Vector) -> Vector {
    return x;
}

const IMAGES: u32 = 1u;

fn image(x: Vector, number: u32, reach: f32, y: ptr<function, Vector>) -> bool {
    *y = x;
    return true;
}
#end
