// Neighbors with the kernel's gradients there, which the loops go over many times: a neighbor is one load, and no kernel is
// computed twice. Particles see each other with exactly opposite gradients, so momentum is kept to rounding.
#import common/vector
#import storage/lists/row

// Low word: 26 bits of the particle's index (a list of more does not fit an adapter), 6 bits of the gradient's z.
// High word: 13 bits of x, 13 bits of y, 6 bits of z.
alias Pair = vec2u;

const INDEX_BITS: u32 = 26u;
// Largest numbers of components with 13 and 12 bits.
const FINE: f32 = 4095.0;
const COARSE: f32 = 2047.0;

// A gradient in units of the steepest one, so each component is at most 1.
fn pack_pair(j: u32, gradient: Vector) -> Pair {
    let g = vec3i(round(to_3d(gradient) * vec3f(FINE, FINE, COARSE)));
    let z = u32(g.z) & 0xfffu;
    let low = j | (z << INDEX_BITS);
    let high = (u32(g.x) & 0x1fffu) | ((u32(g.y) & 0x1fffu) << 13u) | ((z >> 6u) << 26u);
    return vec2u(low, high);
}

fn pair_particle(pair: Pair) -> u32 {
    return pair.x & ((1u << INDEX_BITS) - 1u);
}

fn pair_gradient(pair: Pair) -> Vector {
    let x = bitcast<i32>(pair.y << 19u) >> 19u;
    let y = bitcast<i32>(pair.y << 6u) >> 19u;
    let z = bitcast<i32>((pair.y & 0xfc000000u) | ((pair.x >> INDEX_BITS) << 20u)) >> 20u;
    return first(vec4f(vec3f(vec3i(x, y, z)), 0.0));
}

// What a component of `pair_gradient` is worth, in units of the steepest gradient.
fn gradient_unit() -> Vector {
    return first(vec4f(1.0 / FINE, 1.0 / FINE, 1.0 / COARSE, 0.0));
}

// Where the pairs of particle i begin; from one to the next are LIST_LANES.
fn pair_row(i: u32) -> u32 {
    return interleaved_row(i, grid.list_capacity);
}
