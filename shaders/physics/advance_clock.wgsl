#flag advances_clock
#import physics/clock
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
    clock.step_in_segment += 1u;
    clock.step += 1u;
#if lists
    decide_search();
#end
}
