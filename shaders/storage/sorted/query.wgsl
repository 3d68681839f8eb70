// Storages that put particles in voxel order: a span of voxels is one range of particles (Green 2012).
#import storage/sorted/entries
#import <addressing>

// First particle of each voxel and of the quarantine behind them, and one more: the particle count.
var<storage, read> voxel_start: array<u32>;

#if separated
const RANGES: u32 = 2u * SPANS;
#else
const RANGES: u32 = SPANS;
#end

// Slots [first, last) of the k-th range of candidates around a voxel.
fn candidate_range(home: Coordinate, k: u32) -> vec2u {
    var voxels = span(home, k % SPANS);
    if voxels.x >= voxels.y {
        return vec2u(0u);
    }
#if separated
    voxels += k / SPANS * row_length(voxel_total());
#end
    return vec2u(voxel_start[voxels.x], voxel_start[voxels.y]);
}

// For lists: ranges by twos, those of all but boundary particles in x and y, those of boundary particles in z and w.
const RANGE_PAIRS: u32 = SPANS;

// What `range_pair` is given, which is the same for all ranges.
fn second_row() -> u32 {
    return row_length(voxel_total());
}

fn range_pair(home: Coordinate, k: u32, second: u32) -> vec4u {
    let voxels = span(home, k);
    if voxels.x >= voxels.y {
        return vec4u(0u);
    }
    var pair = vec4u(voxel_start[voxels.x], voxel_start[voxels.y], 0u, 0u);
#if separated
    pair.z = voxel_start[voxels.x + second];
    pair.w = voxel_start[voxels.y + second];
#end
    return pair;
}

// From one slot of a range to the next.
const SLOT_STEP: u32 = 1u;

// The particle in a slot.
fn candidate(slot: u32) -> u32 {
    return slot;
}

// Particles in a voxel.
fn occupancy(voxel: u32) -> u32 {
    var particles = voxel_start[voxel + 1u] - voxel_start[voxel];
#if separated
    let second = voxel + row_length(voxel_total());
    particles += voxel_start[second + 1u] - voxel_start[second];
#end
    return particles;
}
