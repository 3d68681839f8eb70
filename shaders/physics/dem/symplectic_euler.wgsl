// Contact forces and symplectic Euler: v' = v + a(x, v) dt, x' = x + v' dt (Rojas 2013, Eq. 7).
#flag moves
#import common/thread
#import physics/dem/contacts
#import physics/guard
#import physics/time_step
#import physics/next
#if adaptive_step
#import physics/extremes
#end
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
    let dt = time_step();
    let a = acceleration_of(sum_contacts(i), v);
    v += dt * a;
    var moved = x + dt * v;
#if clamp_walls
    clamp_to_walls(&moved, &v);
#end
    watch(i, x, &moved, &v);
    leave(i, moved, pack(v));
#if adaptive_step
    note_extremes(a, length(v), 0.0);
#end
}
