// Decides after a move whether particles are searched anew or keep their places and lists. At the end of a frame they
// are searched in any case: pictures look at the grid, and a resumed run finds the same lists.
//
// The host records several steps and then a search, over and over. Once lists no longer serve, or steps end, the rest
// of the recorded steps moves nothing; a search whose lists still serve finds nothing to do. Recorded steps go by
// twos: the first moves particles into the `next_` buffers, the second returns them.
#import common/vector
#import common/thread
#import cells/grid
#import cells/reallocation
#import physics/clock
#import physics/guard
#if adaptive_step
#import physics/step_control
#end
#if straight_paths
#import physics/time_step
#end
#import storage/lists/state

// Arguments of an indirect dispatch: whether the passes that lay out the grid run.
var<storage, read_write> search_dispatch: vec4u;

// Has a kind of passes run over its particles, or over none.
fn set_particles(which: u32, run: bool) {
    var base = DISPATCH_PARTICLES;
    if which >= DISPATCH_FREE {
        base = select(DISPATCH_FREE, DISPATCH_REACHED, which >= DISPATCH_REACHED);
    }
    let particles = dispatch[base];
    dispatch[which] = select(vec4u(0u, 0u, 0u, particles.w), particles, run);
}

fn set_moving(moves: bool) {
    set_particles(DISPATCH_MOVING, moves);
    set_particles(DISPATCH_MOVING_FREE, moves);
    set_particles(DISPATCH_MOVING_REACHED, moves);
}

fn set_returning(moves: bool) {
    set_particles(DISPATCH_RETURNING, moves);
    set_particles(DISPATCH_RETURNING_FREE, moves);
    set_particles(DISPATCH_RETURNING_REACHED, moves);
}

fn set_kept(serve: bool) {
    set_particles(DISPATCH_KEPT, serve);
    set_particles(DISPATCH_KEPT_FREE, serve);
    set_particles(DISPATCH_KEPT_REACHED, serve);
}

fn set_search(runs: bool) {
    set_particles(DISPATCH_SEARCHED, runs);
    set_particles(DISPATCH_SEARCHED_FREE, runs);
    set_particles(DISPATCH_SEARCHED_REACHED, runs);
    search_dispatch = vec4u(u32(runs), 1u, 1u, 0u);
}

#if adaptive_step
fn steps_are_left() -> bool {
    return clock.step != list_state.last_step && step_control.left != 0u && step_control.stalled == 0u;
}

fn frame_ends() -> bool {
    return step_control.left == 0u && step_control.ends_frame != 0u;
}
#else
fn steps_are_left() -> bool {
    return clock.step != list_state.last_step;
}

fn frame_ends() -> bool {
    return (clock.step - list_state.first_step) % grid.frame_steps == 0u;
}
#end

// Whether the recorded step that this pass belongs to moved particles.
fn has_moved() -> bool {
    if (dispatch[DISPATCH_MOVING].x | dispatch[DISPATCH_RETURNING].x) != 0u {
        return true;
    }
    set_kept(false);
    return false;
}

#if straight_paths
// Lists look ahead for so many times what the last ones lasted; of the longest steps, at least and at most.
const LOOK_AHEAD: f32 = 1.5;
const FEWEST_AHEAD: f32 = 3.0;
const MOST_AHEAD: f32 = 40.0;

// Whether the next step may end behind what lists looked ahead. Where lists end, it says how far the next ones look; those of a
// frame's end look as far as those of the start, as a run does that goes on from there.
fn horizon_ends() -> bool {
    let longest_step = grid.list_horizon / f32(PATH_STEPS);
    guard.listed_for += time_step();
    let ends = guard.listed_for + longest_step > list_horizon();
    if frame_ends() {
        list_state.horizon = 0.0;
    } else if ends || atomicLoad(&guard.far) != 0u {
        let steps = clamp(LOOK_AHEAD * guard.listed_for / longest_step, FEWEST_AHEAD, MOST_AHEAD);
        list_state.horizon = steps * longest_step;
    }
    return ends;
}
#else
fn horizon_ends() -> bool {
    return false;
}
#end

fn decide_search() {
#if lists_every_step
    let due = true;
#else
    let ends = horizon_ends();
    let due = ends || atomicLoad(&guard.far) != 0u || frame_ends();
#end
    let returned = dispatch[DISPATCH_RETURNING].x != 0u;
    let goes_on = !due && steps_are_left();
    atomicStore(&guard.far, 0u);
    list_state.searches += u32(due);
    set_search(due);
    set_kept(!due);
    set_moving(goes_on && returned);
    set_returning(goes_on && !returned);
    set_particles(DISPATCH_AWAY, !due && !returned);
    set_particles(DISPATCH_RETURNED, due && returned);
#if fixed_room
    if due {
        _ = set_voxels(grid.capacity);
    }
#end
}
