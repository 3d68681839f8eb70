// Decides after a move whether particles are searched anew or keep their places and lists. At the end of a frame they
// are searched in any case: pictures look at the grid, and a resumed run finds the same lists.
//
// The host records several steps and then a search, over and over. Once lists no longer serve, or steps end, the rest
// of the recorded steps moves nothing; a search whose lists still serve finds nothing to do.
#import common/vector
#import common/thread
#import cells/grid
#import cells/growth
#import physics/clock
#import storage/lists/state

// Arguments of an indirect dispatch: whether the passes that lay out the grid run.
var<storage, read_write> search_dispatch: vec4u;

fn nobody() -> vec4u {
    return vec4u(0u, 0u, 0u, dispatch[DISPATCH_PARTICLES].w);
}

// Whether the recorded step that this pass belongs to moved particles.
fn has_moved() -> bool {
    if dispatch[DISPATCH_MOVING].x != 0u {
        return true;
    }
    dispatch[DISPATCH_KEPT] = nobody();
    return false;
}

// Says who moves in the next step.
fn set_moving(lists_serve: bool) {
    let moves = lists_serve && clock.step != list_state.last_step;
    dispatch[DISPATCH_MOVING] = select(nobody(), dispatch[DISPATCH_PARTICLES], moves);
}

fn decide_search() {
    let due = atomicLoad(&list_state.moved) != 0u || (clock.step - list_state.first_step) % grid.frame_steps == 0u;
    atomicStore(&list_state.moved, 0u);
    list_state.searches += u32(due);
    let particles = dispatch[DISPATCH_PARTICLES];
    dispatch[DISPATCH_SEARCHED] = select(nobody(), particles, due);
    dispatch[DISPATCH_KEPT] = select(particles, nobody(), due);
    search_dispatch = vec4u(u32(due), 1u, 1u, 0u);
    set_moving(!due);
#if fixed_room
    if due {
        _ = set_voxels(grid.capacity);
    }
#end
}
