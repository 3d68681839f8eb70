// How full the voxels are, as a square picture for the host.
#import common/thread
#import storage/fold

// VOXEL_MAP_SIDE² particle counts, rows from the top; NO_VOXEL where there is none.
var<storage, read_write> voxel_map: array<u32>;

@compute @workgroup_size(GROUP_SIZE)
fn map_voxels(thread: Thread) {
    let item = item_index(thread);
    if item >= VOXEL_MAP_SIDE * VOXEL_MAP_SIDE {
        return;
    }
    voxel_map[item] = fullest_at(vec2u(item % VOXEL_MAP_SIDE, item / VOXEL_MAP_SIDE), VOXEL_MAP_SIDE);
}
