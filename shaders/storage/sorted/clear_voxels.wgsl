// Begins a search of a storage in voxel order: no voxel has particles yet.
#import common/thread
#import storage/sorted/entries
#import <addressing>

var<storage, read_write> voxel_start: array<u32>;

// A workgroup clears as many voxels as it scans later. Behind the voxels stands the quarantine.
@compute @workgroup_size(SCAN_THREADS)
fn clear_voxels(thread: Thread) {
    let begin = group_index(thread) * SCAN_THREADS * SCAN_ITEMS;
    let end = min(begin + SCAN_THREADS * SCAN_ITEMS, entries(voxel_total()));
    for (var voxel = begin + thread.local_index; voxel < end; voxel += SCAN_THREADS) {
        voxel_start[voxel] = 0u;
    }
}
