// Takes a particle from where a step left it to its slot in the order of the search.
#import common/vector
#import storage/next_id
#import storage/next_position

var<storage, read> next_velocity: array<Packed>;
var<storage, read_write> position: array<Packed>;
var<storage, read_write> velocity: array<Packed>;
var<storage, read_write> id: array<u32>;
#if accelerations
var<storage, read> next_acceleration: array<Packed>;
var<storage, read_write> acceleration: array<Packed>;
#end
#if continuity
var<storage, read> next_excess: array<f32>;
var<storage, read_write> excess: array<f32>;
#end
#if several_materials
var<storage, read> next_material: array<u32>;
var<storage, read_write> material: array<u32>;
#end

fn place(i: u32, slot: u32) {
    position[slot] = next_position[i];
    velocity[slot] = next_velocity[i];
    id[slot] = next_id[i];
#if accelerations
    acceleration[slot] = next_acceleration[i];
#end
#if continuity
    excess[slot] = next_excess[i];
#end
#if several_materials
    material[slot] = next_material[i];
#end
}
