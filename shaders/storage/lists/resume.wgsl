// Behind a recorded search, whether it found something to do or not: particles are in their place, and steps go on.
#import storage/lists/decide

@compute @workgroup_size(1)
fn resume_steps() {
    if search_state.halted != 0u {
        return;
    }
    set_search(false);
    dispatch[DISPATCH_SCAN] = vec4u(0u, 0u, 0u, dispatch[DISPATCH_SCAN].w);
    set_moving(steps_are_left());
    set_returning(false);
    set_particles(DISPATCH_AWAY, false);
    set_particles(DISPATCH_RETURNED, false);
}
