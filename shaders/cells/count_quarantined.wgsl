// Counts the particles that the search does not follow, for addressings that have no other look at all particles.
#import common/vector
#import common/thread
#import common/parameters
#import cells/grid
#import cells/growth

var<storage, read> next_position: array<Packed>;

@compute @workgroup_size(GROUP_SIZE)
fn count_quarantined(thread: Thread) {
    let i = item_index(thread);
    if i < parameters.particle_count && is_quarantined(voxel_of(unpack(next_position[i]))) {
        atomicAdd(&search_state.quarantined_so_far, 1u);
    }
}

@compute @workgroup_size(1)
fn note_quarantined() {
    _ = set_voxels(grid.capacity);
}
