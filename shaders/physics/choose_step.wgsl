// Chooses the length of the next step from what the step before noted (physics::step_control has the limits).
#import physics/step_control
#import physics/extremes

struct StepControlLimits {
    constant: f32, // the shortest of the limits that never change, s
    courant_distance: f32, // how far motion and sound may go in a step, m
    fall: f32, // a step is at most √(fall / acceleration), m
    sound_speed: f32, // at rest density, m/s; 0 for grains
    expected_speed: f32, // m/s; 0 for grains
    shortest: f32, // a run with steps shorter than this stops, s
}

var<uniform> step_limits: StepControlLimits;

// What limits a step (physics::step_control::LIMITS): STIFFNESS where the fluid is pressed so much that sound is faster in
// it than expected, MOTION where something is faster than expected, FRAME where the end of a frame or of what goes on in it
// does.

// A step may be longer than the one before by this factor, and shorter by any.
const GROWTH: f32 = 1.1;
// A step that is shorter than wanted by this factor or more is so for the segment's end.
const CUT_SHORT: f32 = 0.9;

// One thread, when a step has been made.
fn count_step() {
    step_control.step = step_control.next_step;
    step_control.left -= step_control.next_ticks;
    let first = step_control.longest == 0.0;
    step_control.shortest = select(min(step_control.shortest, step_control.step), step_control.step, first);
    step_control.longest = max(step_control.longest, step_control.step);
    step_control.made[select(step_control.limit, LIMIT_FRAME, step_control.step < CUT_SHORT * step_control.wanted)] += 1u;
}

fn choose_step() {
    let acceleration = bitcast<f32>(atomicExchange(&guard.extremes.acceleration, 0u));
    let noted = bitcast<f32>(atomicExchange(&guard.extremes.signal, 0u));
    let sound = max(bitcast<f32>(atomicExchange(&guard.extremes.sound, 0u)), step_limits.sound_speed);
    let signal = max(noted, step_limits.sound_speed + step_control.obstacle_speed);

    let stiffer = sound - step_limits.sound_speed;
    let faster = signal - sound - step_limits.expected_speed;
    let unexpected = select(LIMIT_MOTION, LIMIT_STIFFNESS, stiffer > faster);
    let as_expected = signal <= step_limits.sound_speed + step_limits.expected_speed;
    let by_signal = step_limits.courant_distance / max(signal, 1e-30);
    let by_acceleration = sqrt(step_limits.fall / max(acceleration, 1e-30));

    var allowed = step_limits.constant;
    var limit = LIMIT_CONSTANT;
    if by_signal < allowed {
        allowed = by_signal;
        limit = select(unexpected, LIMIT_SOUND, as_expected);
    }
    if by_acceleration < allowed {
        allowed = by_acceleration;
        limit = LIMIT_ACCELERATION;
    }
    // While steps grow, what made them short is what limits them.
    let grown = GROWTH * step_control.wanted;
    step_control.limit = select(step_control.limit, limit, allowed <= grown);
    step_control.wanted = min(allowed, grown);
    step_control.stalled = u32(step_control.wanted < step_limits.shortest);

    // What is left of the segment is cut into equal steps, so that none is a sliver
    // (physics::step_control::StepControl::aim).
    let steps = ceil(f32(step_control.left) * step_control.tick / step_control.wanted - ROUNDING);
    step_control.next_ticks = select(max(u32(f32(step_control.left) / steps), 1u), step_control.left, steps <= 1.0);
    step_control.next_step = f32(step_control.next_ticks) * step_control.tick;
}
