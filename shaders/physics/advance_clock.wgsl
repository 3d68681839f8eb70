#flag advances_clock
#import physics/clock
#import physics/guard
#import fields/id
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
        for (var k = 0u; k < min(atomicLoad(&guard.noted), ACCIDENTS); k++) {
            guard.accidents[k].id = id[guard.accidents[k].id];
        }
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
