// Decides after a move whether particles are searched anew or keep their places and lists. At the end of a frame they
// are searched in any case: pictures look at the grid, and a resumed run finds the same lists.
#import common/vector
#import common/thread
#import cells/grid
#import cells/growth
#import physics/clock
#import storage/lists/state

@compute @workgroup_size(1)
fn decide_search() {
    if search_state.halted != 0u {
        return;
    }
    let due = atomicLoad(&list_state.moved) != 0u || (clock.step - list_state.first_step) % grid.frame_steps == 0u;
    atomicStore(&list_state.moved, 0u);
    search_state.searching = u32(due);
    list_state.searches += u32(due);
    let particles = dispatch[DISPATCH_PARTICLES];
    let none = vec4u(0u, 0u, 0u, particles.w);
    dispatch[DISPATCH_SEARCHED] = select(none, particles, due);
    dispatch[DISPATCH_SEARCHED_ONCE] = select(none, vec4u(1u, 1u, 1u, particles.w), due);
    dispatch[DISPATCH_KEPT] = select(particles, none, due);
    dispatch[DISPATCH_VOXELS] = none;
    dispatch[DISPATCH_SCAN] = none;
#if fixed_room
    _ = set_voxels(grid.capacity);
#end
}
