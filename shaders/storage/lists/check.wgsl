// Whether every list had room; from here on the new lists serve.
#import common/vector
#import common/thread
#import cells/grid
#import cells/reallocation
#import storage/lists/state
#if straight_paths
#import physics/guard
#end

@compute @workgroup_size(1)
fn check_lists() {
    if search_state.halted != 0u {
        return;
    }
#if straight_paths
    guard.listed_for = 0.0;
#end
    search_state.longest_list = atomicLoad(&list_state.longest);
    atomicStore(&list_state.longest, 0u);
    _ = fits(search_state.longest_list, grid.list_capacity);
}
