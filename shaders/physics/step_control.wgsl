// How far a run has come, and how long steps are, where the device chooses them (physics::step_control).
#import host/step_limits

struct StepControl {
    left: u32, // ticks until the segment ends
    tick: f32, // s
    ends_frame: u32, // not zero: a frame ends with the segment
    obstacle_speed: f32, // of the fastest one in this segment, m/s
    step: f32, // length of the step made last, s
    next_step: f32, // of the step that comes, s
    next_ticks: u32,
    wanted: f32, // what the limits allow that step, s
    limit: u32, // which limit that is
    stalled: u32, // not zero: steps would be so short that the run would never end
    shortest: f32, // step since the last frame, s
    longest: f32,
    made: array<u32, LIMITS>, // steps since the last frame, by what limited them
}

#if advances_clock
var<storage, read_write> step_control: StepControl;
#else
var<storage, read> step_control: StepControl;
#end

// Time since the segment began, s.
fn segment_time() -> f32 {
    return f32(SEGMENT_TICKS - step_control.left) * step_control.tick;
}
