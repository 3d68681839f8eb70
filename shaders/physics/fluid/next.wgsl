// Where a step leaves the fluid's particles for the search.
#import physics/next
#if continuity
var<storage, read_write> next_excess: array<f32>;
#end
#if several_materials
var<storage, read_write> next_material: array<u32>;
#end

fn leave_fluid(i: u32, x: Vector, v: Vector, excess: f32) {
    leave(i, x, v);
#if continuity
    next_excess[i] = excess;
#end
#if several_materials
    next_material[i] = material[i];
#end
}
