// Last part of a velocity Verlet step (see velocity_verlet.wgsl): corrects the predicted velocities.
#import common/vector
#import common/thread
#import common/parameters
#import physics/time_step

var<storage, read> next_acceleration: array<Packed>;
var<storage, read_write> velocity: array<Packed>;
var<storage, read_write> acceleration: array<Packed>;

@compute @workgroup_size(GROUP_SIZE)
fn kick(thread: Thread) {
    let i = item_index(thread);
    if i < parameters.particle_count {
        velocity[i] += 0.5 * time_step() * (next_acceleration[i] - acceleration[i]);
        acceleration[i] = next_acceleration[i];
    }
}
