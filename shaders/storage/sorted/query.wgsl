// Storages that put particles in voxel order: a span of voxels is one range of particles (Green 2012).
#import <addressing>

// First particle of each voxel and of the quarantine behind them, and one more: the particle count.
var<storage, read> voxel_start: array<u32>;

const RANGES: u32 = SPANS;

// Slots [first, last) of the k-th range of candidates around a voxel.
fn candidate_range(home: Coordinate, k: u32) -> vec2u {
    let voxels = span(home, k);
    if voxels.x >= voxels.y {
        return vec2u(0u);
    }
    return vec2u(voxel_start[voxels.x], voxel_start[voxels.y]);
}

// The particle in a slot.
fn candidate(slot: u32) -> u32 {
    return slot;
}

// Particles in a voxel.
fn occupancy(voxel: u32) -> u32 {
    return voxel_start[voxel + 1u] - voxel_start[voxel];
}
