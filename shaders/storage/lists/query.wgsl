// Candidates from each particle's list (Verlet 1967), which serves as long as no particle has moved far.
#import common/vector
#import cells/grid

#import storage/lists/row

var<storage, read> neighbor_list: array<u32>;

// The second one has boundary particles alone, and the first one none.
#if walls_apart
const RANGES: u32 = 2u;
#else
const RANGES: u32 = 1u;
#end

fn around(i: u32, x: Vector) -> u32 {
    return i;
}

// Slots [first, last) of a particle's list.
fn candidate_range(home: u32, k: u32) -> vec2u {
    let row = list_row(home);
    let begin = row + LIST_HEAD * LIST_LANES;
#if walls_apart
    if k == 1u {
        let end = begin + grid.list_capacity * LIST_LANES;
        return vec2u(end - neighbor_list[row + LIST_LANES] * LIST_LANES, end);
    }
#end
    return vec2u(begin, begin + neighbor_list[row] * LIST_LANES);
}

// From one slot of a range to the next.
const SLOT_STEP: u32 = LIST_LANES;

// The particle in a slot.
fn candidate(slot: u32) -> u32 {
    return neighbor_list[slot];
}
