// Candidates from each particle's list (Verlet 1967), which serves as long as no particle has moved far.
#import common/vector
#import cells/grid

// A row per particle: how many neighbors it has, then they, with room for grid.list_capacity.
var<storage, read> neighbor_list: array<u32>;

const RANGES: u32 = 1u;

fn around(i: u32, x: Vector) -> u32 {
    return i;
}

// Slots [first, last) of a particle's list.
fn candidate_range(home: u32, k: u32) -> vec2u {
    let row = home * (grid.list_capacity + 1u);
    return vec2u(row + 1u, row + 1u + neighbor_list[row]);
}

// The particle in a slot.
fn candidate(slot: u32) -> u32 {
    return neighbor_list[slot];
}
