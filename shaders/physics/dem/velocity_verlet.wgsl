// Velocity Verlet: drift, (neighbor search,) contact forces, kick.
//
// Without damping the scheme is x' = x + v dt + a dt²/2, v' = v + (a + a') dt/2, of second order. A dashpot needs the
// velocity that is still to be computed: `drift` predicts it as v + a dt, and `kick` corrects it by (a' - a) dt/2,
// which keeps the order.
#import common/thread
#import physics/dem/contacts

var<storage, read_write> next_acceleration: array<Packed>;

// Accelerations at the new positions, in cell order.
@compute @workgroup_size(GROUP_SIZE)
fn sum_forces(thread: Thread) {
    let i = item_index(thread);
    if i < parameters.particle_count {
        next_acceleration[i] = pack(acceleration_of(sum_contacts(i), unpack(velocity[i])));
    }
}
