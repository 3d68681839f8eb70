#flag advances_clock
#import physics/clock
#import physics/guard
#if adaptive_step
#import physics/choose_step
#end
#if lists
#import storage/lists/decide
#end

// One thread, once a step.
@compute @workgroup_size(1)
fn advance_clock() {
#if lists
    if !has_moved() {
        return;
    }
#end
    if atomicLoad(&guard.count) > 0u && guard.step == GUARD_NO_STEP {
        guard.step = clock.step;
    }
    clock.step_in_segment += 1u;
    clock.step += 1u;
#if adaptive_step
    count_step();
    choose_step();
#end
#if lists
    decide_search();
#end
}
