// Chooses the length of the next step from what the step before noted (physics::pace has the limits).
#import physics/pace
#import physics/extremes

struct PaceLimits {
    constant: f32, // the shortest of the limits that never change, s
    way: f32, // that motion and sound may go in a step, m
    fall: f32, // a step is at most √(fall / acceleration), m
    sound_speed: f32, // at rest density, m/s; 0 for grains
    expected_speed: f32, // m/s; 0 for grains
    shortest: f32, // a run with steps shorter than this stops, s
}

var<uniform> pace_limits: PaceLimits;

// What limits a step (physics::pace::LIMITS): STIFFNESS where the fluid is pressed so much that sound is faster in it than
// expected, MOTION where something is faster than expected, FRAME where the end of a frame or of what goes on in it does.

// A step may be longer than the one before by this factor, and shorter by any.
const GROWTH: f32 = 1.1;
// A step that is shorter than wanted by this factor or more is so for the segment's end.
const CUT_SHORT: f32 = 0.9;

// One thread, when a step has been made.
fn count_step() {
    pace.step = pace.next_step;
    pace.left -= pace.next_ticks;
    let first = pace.longest == 0.0;
    pace.shortest = select(min(pace.shortest, pace.step), pace.step, first);
    pace.longest = max(pace.longest, pace.step);
    pace.made[select(pace.limit, LIMIT_FRAME, pace.step < CUT_SHORT * pace.wanted)] += 1u;
}

fn choose_step() {
    let acceleration = bitcast<f32>(atomicExchange(&extremes.acceleration, 0u));
    let noted = bitcast<f32>(atomicExchange(&extremes.signal, 0u));
    let sound = max(bitcast<f32>(atomicExchange(&extremes.sound, 0u)), pace_limits.sound_speed);
    let signal = max(noted, pace_limits.sound_speed + pace.obstacle_speed);

    let stiffer = sound - pace_limits.sound_speed;
    let faster = signal - sound - pace_limits.expected_speed;
    let unexpected = select(LIMIT_MOTION, LIMIT_STIFFNESS, stiffer > faster);
    let as_expected = signal <= pace_limits.sound_speed + pace_limits.expected_speed;
    let by_signal = pace_limits.way / max(signal, 1e-30);
    let by_acceleration = sqrt(pace_limits.fall / max(acceleration, 1e-30));

    var allowed = pace_limits.constant;
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
    let grown = GROWTH * pace.wanted;
    pace.limit = select(pace.limit, limit, allowed <= grown);
    pace.wanted = min(allowed, grown);
    pace.stalled = u32(pace.wanted < pace_limits.shortest);

    // What is left of the segment is cut into equal steps, so that none is a sliver (physics::pace::Pace::aim).
    let steps = ceil(f32(pace.left) * pace.tick / pace.wanted - ROUNDING);
    pace.next_ticks = select(max(u32(f32(pace.left) / steps), 1u), pace.left, steps <= 1.0);
    pace.next_step = f32(pace.next_ticks) * pace.tick;
}
