// Prefix sum of the voxels' particle counts, in place: the first particle of each voxel, empty ones included.
#import storage/scan
#import storage/sorted/entries
#import <addressing>

// Counts before, first particles after.
var<storage, read_write> voxel_start: array<u32>;

// The last entry's count is zero, and its start is the particle count.
fn scan_items() -> u32 {
    return entries(voxel_total());
}

fn scan_value(voxel: u32) -> u32 {
    return voxel_start[voxel];
}

fn scan_result(voxel: u32, before: u32) {
    voxel_start[voxel] = before;
}
