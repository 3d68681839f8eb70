// Storage `pool`: SLOTS indices a voxel (Harada 2007's index pool; Green 2012's gridCounters and gridCells).
#import <addressing>

// Particles that fell into each voxel; more than SLOTS is overflow.
var<storage, read> voxel_count: array<u32>;
// SLOTS particle indices a voxel.
var<storage, read> index_pool: array<u32>;

const RANGES: u32 = SPANS * SPAN_VOXELS;

// Slots [first, last) of the k-th range of candidates around a voxel.
fn candidate_range(home: Coordinate, k: u32) -> vec2u {
    let voxels = span(home, k / SPAN_VOXELS);
    let voxel = voxels.x + k % SPAN_VOXELS;
    if voxel >= voxels.y {
        return vec2u(0u);
    }
    let slot = voxel * SLOTS;
    return vec2u(slot, slot + min(voxel_count[voxel], SLOTS));
}

// For lists; boundary particles stand among the others.
const RANGE_PAIRS: u32 = RANGES;

fn second_row() -> u32 {
    return 0u;
}

fn range_pair(home: Coordinate, k: u32, second: u32) -> vec4u {
    return vec4u(candidate_range(home, k), 0u, 0u);
}

// From one slot of a range to the next.
const SLOT_STEP: u32 = 1u;

// The particle in a slot.
fn candidate(slot: u32) -> u32 {
    return index_pool[slot];
}

// Particles in a voxel, those without a slot included.
fn occupancy(voxel: u32) -> u32 {
    return voxel_count[voxel];
}
