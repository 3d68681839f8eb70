// Counts the particles that the search does not follow, for addressings that have no other look at all particles.
#import <marks>
#import cells/reallocation

@compute @workgroup_size(GROUP_SIZE)
fn count_quarantined(thread: Thread) {
    if is_quarantined(next_voxel(thread)) {
        atomicAdd(&search_state.quarantined_so_far, 1u);
    }
}

@compute @workgroup_size(1)
fn note_quarantined() {
    _ = set_voxels(grid.capacity);
}
