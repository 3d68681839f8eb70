// Where a step leaves the fluid's particles for the search.
#import physics/next
#if continuity
#import fields/velocity/pack
#end

fn leave_fluid(i: u32, x: Vector, v: Vector, deviation: f32) {
#if continuity
    leave(i, x, pack_velocity(v, deviation));
#else
    leave(i, x, pack(v));
#end
}
