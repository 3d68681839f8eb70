// Velocity Verlet: drift, (neighbor search, density with the predicted velocities,) forces, kick. Of second order, as
// physics/dem/velocity_verlet.wgsl says.
#import common/thread
#import physics/fluid/forces

var<storage, read_write> next_acceleration: array<Packed>;

@compute @workgroup_size(GROUP_SIZE)
fn sum_fluid_forces(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    var acceleration = Vector(0.0);
    if !is_boundary(i) {
        acceleration = forces_on(i).acceleration;
    }
    next_acceleration[i] = pack(acceleration);
}
