// Which boundary particles are in reach, by their place among all boundary particles.
#import common/parameters

// 32 bits, and the number of those set before them.
var<storage, read> reach_word: array<vec2u>;

fn reach_bit(i: u32) -> u32 {
    return 1u << ((i - parameters.free_count) % 32u);
}

fn is_reached(i: u32) -> bool {
    return (reach_word[(i - parameters.free_count) / 32u].x & reach_bit(i)) != 0u;
}

// Number of boundary particles in reach before this one.
fn reached_before(i: u32) -> u32 {
    let word = reach_word[(i - parameters.free_count) / 32u];
    return word.y + countOneBits(word.x & (reach_bit(i) - 1u));
}
