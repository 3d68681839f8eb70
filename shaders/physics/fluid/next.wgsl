// Where a step leaves the fluid's particles for the search.
#import physics/next
#if continuity
#import fields/next_density_deviation/write
#end

fn leave_fluid(i: u32, x: Vector, v: Vector, deviation: f32) {
    leave(i, x, v);
#if continuity
    next_density_deviation[i] = deviation;
#end
}
