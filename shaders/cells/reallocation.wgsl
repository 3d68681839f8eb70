// What a search needs, and how many threads the passes behind it run. Where a table or a buffer of voxels is too small,
// the passes that would use it are dispatched with nothing, until the host has made more room and searches again
// (simulation/reallocation.rs).

#import storage/sorted/entries
#import host/dispatch

struct SearchState {
    halted: u32, // not zero: there was too little room, and nothing runs
    voxels: u32, // that this search has, or would have
    rows: u32,
    words: u32,
    quarantined: u32, // particles that the search does not follow
    quarantined_so_far: atomic<u32>, // the same while they are counted
    longest_list: u32, // of neighbors
    reached: u32, // boundary particles in reach of fluid
}

var<storage, read_write> search_state: SearchState;
// Arguments of indirect dispatches: x, y, z, and in w the groups that fit in one dimension (gpu::Items).
var<storage, read_write> dispatch: array<vec4u>;

fn set_groups(which: u32, groups: u32) {
    let most = dispatch[which].w;
    dispatch[which] = vec4u(min(groups, most), (groups + most - 1u) / most, 1u, most);
}

// One thread, when a table would have `needed` entries and has room for `capacity`. Tells whether it fits.
fn fits(needed: u32, capacity: u32) -> bool {
    if needed <= capacity {
        return true;
    }
    search_state.halted = 1u;
    for (var which = 0u; which < DISPATCHES; which++) {
        dispatch[which] = vec4u(0u, 0u, 0u, dispatch[which].w);
    }
    return false;
}

// One thread, when the number of voxels is known. Tells whether there is room for them.
fn set_voxels(voxels: u32) -> bool {
    if search_state.halted != 0u {
        return false;
    }
    search_state.voxels = voxels;
    search_state.quarantined = atomicLoad(&search_state.quarantined_so_far);
    atomicStore(&search_state.quarantined_so_far, 0u);
    if !fits(voxels, grid.capacity) {
        return false;
    }
    set_groups(DISPATCH_VOXELS, (voxels + GROUP_SIZE - 1u) / GROUP_SIZE);
    set_groups(DISPATCH_SCAN, (entries(voxels) + SCAN_THREADS * SCAN_ITEMS - 1u) / (SCAN_THREADS * SCAN_ITEMS));
    return true;
}
