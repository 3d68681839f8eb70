// Where a step leaves particles for the search.
#import physics/present
#import fields/next_position/write
#import fields/next_velocity/write
#if lists
#import storage/lists/watch
#end

// The velocity with what stands beside it.
fn leave(i: u32, x: Vector, v: Packed) {
    next_position[i] = pack(x);
    next_velocity[i] = v;
#if lists
    watch_list(i, x);
#end
}
