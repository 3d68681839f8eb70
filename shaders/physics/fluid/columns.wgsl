// At the end of a frame: the fluid's columns.
#import common/thread
#import common/vector
#import common/parameters
#import physics/fluid/pairs
#import physics/fluid/material
#import physics/fluid/state
#import fields/measured

#if column_contacts
// Particles within the support of particle i. Nobody asks that of boundary particles, which may have no lists.
fn reached_by(i: u32) -> u32 {
    var reached = 0u;
    if is_boundary(i) {
        return reached;
    }
    let x = unpack(position[i]);
    let home = around(i, x);
    for (var k = 0u; k < RANGES; k++) {
        let range = candidate_range(home, k);
        for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
            let j = candidate(slot);
            reached += select(0u, 1u, within(toward(x, j), fluid.support) && j != i);
        }
    }
    return reached;
}
#end

@compute @workgroup_size(GROUP_SIZE)
fn measure_columns(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
#if column_contacts
    contacts[i] = reached_by(i);
#end
#if column_pressure
    pressure[i] = fluid_state[i].y;
#end
#if column_density
    density[i] = material_of(i).density * (1.0 + fluid_state[i].x);
#end
}
