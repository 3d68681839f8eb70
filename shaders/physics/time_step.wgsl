// The length of a step, s: for passes that move particles (flag `moves`) of the step that comes, for those behind them
// of the step just made.
#if adaptive_step
#import physics/step_control

fn time_step() -> f32 {
#if moves
    return step_control.next_step;
#else
    return step_control.step;
#end
}
#else
#import common/parameters

fn time_step() -> f32 {
    return parameters.time_step;
}
#end
