// Where a step leaves the fluid's particles for the search.
#import physics/next
#if continuity
#import fields/next_excess/write
#end

fn leave_fluid(i: u32, x: Vector, v: Vector, excess: f32) {
    leave(i, x, v);
#if continuity
    next_excess[i] = excess;
#end
}
