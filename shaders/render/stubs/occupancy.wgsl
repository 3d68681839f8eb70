// For tests of the heatmap alone: counts in a buffer.

var<storage, read> voxel_count: array<u32>;
var<storage, read> voxel_sum: array<u32>;

const SLOTS: u32 = 4u;

fn occupancy(voxel: u32) -> u32 {
    return voxel_count[voxel];
}

fn voxel_total() -> u32 {
    return voxel_sum[0];
}
