#import physics/clock

var<storage, read_write> clock: Clock;

// One thread, after a step.
@compute @workgroup_size(1)
fn advance_clock() {
    clock.step_in_segment += 1u;
    clock.step += 1u;
}
