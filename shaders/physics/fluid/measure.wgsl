// At the end of a frame: the fluid's columns, and figures over all of its particles.
#import common/thread
#import common/vector
#import common/parameters
#import physics/fluid/pairs
#import physics/fluid/material
#import physics/fluid/state

#import fields/measured
#if statistics
#import physics/group_sums
#import physics/measure
#end

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
fn measure_fluid(thread: Thread) {
    let i = item_index(thread);
    let alive = i < parameters.particle_count;
#if statistics
    var sums = Sums();
#end
    if alive {
        let state = fluid_state[i];
        let own = material_of(i);
#if column_contacts
        contacts[i] = reached_by(i);
#end
#if column_pressure
        pressure[i] = state.y;
#end
#if column_density
        density[i] = own.density * (1.0 + state.x);
#end
#if statistics
        if !is_boundary(i) {
            let v = unpack(velocity[i]);
            let mass = own.density * fluid.volume;
            sums.kinetic_energy = 0.5 * mass * dot(v, v);
            sums.potential_energy =
                -mass * dot(first(parameters.gravity), unpack(position[i]) - first(measure.reference));
            sums.max_speed = length(v);
            sums.density_error = abs(state.x);
            sums.max_density_error = abs(state.x);
#if clamped_pressure
            sums.clamped_pressures = select(0u, 1u, pressure_at(own.stiffness, state.x) < 0.0);
#if continuity
            sums.clamped_densities = select(0u, 1u, state.x <= fluid.lowest_deviation);
#end
#end
        }
#end
    }
#if statistics
    sum_group(thread, sums);
#end
}
