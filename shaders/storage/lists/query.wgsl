// Candidates from each particle's list (Verlet 1967), which serves as long as no particle has moved far.
#import common/vector
#import cells/grid

// grid.list_capacity entries a particle.
var<storage, read> neighbor_list: array<u32>;
var<storage, read> list_length: array<u32>;

const RANGES: u32 = 1u;

fn around(i: u32, x: Vector) -> u32 {
    return i;
}

// Slots [first, last) of a particle's list.
fn candidate_range(home: u32, k: u32) -> vec2u {
    let first_slot = home * grid.list_capacity;
    return vec2u(first_slot, first_slot + list_length[home]);
}

// The particle in a slot.
fn candidate(slot: u32) -> u32 {
    return neighbor_list[slot];
}
