// Angular velocities, as leapfrog.wgsl has velocities.
#flag moves
#import common/thread
#import common/parameters
#import physics/dem/rotation
#import fields/half_step
#import fields/next_half_step/write
#import fields/angular_velocity
#import fields/next_angular_velocity/write

var<storage, read> contact_acceleration: array<Motion>;

@compute @workgroup_size(GROUP_SIZE)
fn turn_grains(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
#if rigid_bodies
    if number_of(contact_acceleration[i].angular) < 0.0 {
        return;
    }
#end
    let a = unpack_rotation(contact_acceleration[i].angular);
    let dt = number_of(contact_acceleration[i].linear);
    let before = half_step[i];
    let w = unpack_rotation(before.rotation) + 0.5 * (number_of(before.velocity) + dt) * a;
    next_half_step[i].rotation = pack_rotation(w, 0.0);
    next_angular_velocity[i] = pack_rotation(w + 0.5 * dt * a, number_of(angular_velocity[i]));
}
