// Where a step leaves particles for the search.
#import physics/present
#if lists
#import storage/lists/watch
#end

var<storage, read_write> next_position: array<Packed>;
var<storage, read_write> next_velocity: array<Packed>;
var<storage, read_write> next_id: array<u32>;

fn leave(i: u32, x: Vector, v: Vector) {
    next_position[i] = pack(x);
    next_velocity[i] = pack(v);
    next_id[i] = id[i];
#if lists
    watch_list(i, x);
#end
}
