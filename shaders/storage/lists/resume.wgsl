// After a search: steps go on.
#import storage/lists/decide

@compute @workgroup_size(1)
fn resume_steps() {
    if search_state.halted != 0u || search_dispatch.x == 0u {
        return;
    }
    search_dispatch = vec4u(0u, 1u, 1u, 0u);
    dispatch[DISPATCH_SEARCHED] = nobody();
    dispatch[DISPATCH_SCAN] = nobody();
    set_moving(true);
}
