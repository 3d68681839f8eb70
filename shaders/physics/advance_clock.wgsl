#flag advances_clock
#import physics/clock

// One thread, once a step.
@compute @workgroup_size(1)
fn advance_clock() {
    clock.step_in_segment += 1u;
    clock.step += 1u;
}
