// Pairs of voxel and particle, ordered by voxel, then by particle; no two are equal.

#if packed_pairs
// 16 bits each (Rojas 2013).
alias Pair = u32;
const LAST_OF_ALL: Pair = 0xffffffffu;

fn pair_of(voxel: u32, particle: u32) -> Pair {
    return voxel << 16u | particle;
}

fn voxel_in(pair: Pair) -> u32 {
    return pair >> 16u;
}

fn particle_in(pair: Pair) -> u32 {
    return pair & 0xffffu;
}

fn is_before(a: Pair, b: Pair) -> bool {
    return a < b;
}
#else
alias Pair = vec2u;
const LAST_OF_ALL: Pair = vec2u(0xffffffffu);

fn pair_of(voxel: u32, particle: u32) -> Pair {
    return vec2u(voxel, particle);
}

fn voxel_in(pair: Pair) -> u32 {
    return pair.x;
}

fn particle_in(pair: Pair) -> u32 {
    return pair.y;
}

fn is_before(a: Pair, b: Pair) -> bool {
    return a.x < b.x || (a.x == b.x && a.y < b.y);
}
#end
