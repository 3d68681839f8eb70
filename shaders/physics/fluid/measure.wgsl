// At the end of a frame: figures over all particles of the fluid.
#import common/thread
#import common/vector
#import common/parameters
#import physics/present
#import physics/fluid/boundary_particles
#import physics/fluid/coefficients
#import physics/fluid/material
#import physics/fluid/state
#import physics/group_sums
#import physics/measure

@compute @workgroup_size(GROUP_SIZE)
fn measure_fluid(thread: Thread) {
    let i = item_index(thread);
    var sums = Sums();
    if i < parameters.particle_count && !is_boundary(i) {
        let state = fluid_state[i];
        let own = material_of(i);
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
    sum_group(thread, sums);
}
