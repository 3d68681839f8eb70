// Contact forces and symplectic Euler: v' = v + a(x, v) dt, x' = x + v' dt (Rojas 2013, Eq. 7).
#import common/thread
#import physics/dem/contacts
#import physics/guard
#import physics/next
#if clamp_walls
#import physics/clamp_walls
#end

@compute @workgroup_size(GROUP_SIZE)
fn move_grains(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    let x = unpack(position[i]);
    var v = unpack(velocity[i]);
    v += parameters.time_step * acceleration_of(sum_contacts(i), v);
    var moved = x + parameters.time_step * v;
#if clamp_walls
    clamp_to_walls(&moved, &v);
#end
    watch(id[i], clock.step, x, &moved, &v);
    leave(i, moved, v);
}
