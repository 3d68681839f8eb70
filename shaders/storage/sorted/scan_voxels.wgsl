// Prefix sum of the voxels' particle counts: the first particle of each voxel, empty ones included.
#import storage/scan
#import <addressing>

var<storage, read_write> voxel_count: array<u32>;
var<storage, read_write> voxel_start: array<u32>;

// Behind the voxels stands the quarantine, and one entry more: its count is zero, and its start is the particle count.
fn scan_items() -> u32 {
    return voxel_total() + 2u;
}

fn scan_value(voxel: u32) -> u32 {
    return voxel_count[voxel];
}

// Leaves the counts zero for the next search.
fn scan_result(voxel: u32, before: u32) {
    voxel_start[voxel] = before;
    voxel_count[voxel] = 0u;
}
