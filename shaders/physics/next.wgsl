// Where a step leaves particles for the search.
#import physics/present
#if lists
#import storage/lists/watch
#end

var<storage, read_write> next_position: array<Packed>;
var<storage, read_write> next_velocity: array<Packed>;
var<storage, read_write> next_id: array<u32>;
#if several_materials
var<storage, read_write> next_material: array<u32>;
#end

fn leave(i: u32, x: Vector, v: Vector) {
    next_position[i] = pack(x);
    next_velocity[i] = pack(v);
    next_id[i] = id[i];
#if several_materials
    next_material[i] = material[i];
#end
#if lists
    watch_list(i, x);
#end
}
