// First half of a velocity Verlet step (see velocity_verlet.wgsl): positions move, velocities are predicted.
#flag moves
#import common/thread
#import common/parameters
#import physics/guard
#import physics/time_step
#import physics/next
#if adaptive_step
#import physics/extremes
#end
#if clamp_walls
#import physics/clamp_walls
#end

var<storage, read> acceleration: array<Packed>;
var<storage, read_write> next_acceleration: array<Packed>;

@compute @workgroup_size(GROUP_SIZE)
fn drift(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    let dt = time_step();
    let x = unpack(position[i]);
    let a = unpack(acceleration[i]);
    var v = unpack(velocity[i]) + dt * a;
    var moved = x + dt * (v - 0.5 * dt * a);
#if clamp_walls
    clamp_to_walls(&moved, &v);
#end
    watch(i, x, &moved, &v);
    leave(i, moved, pack(v));
#if adaptive_step
    note_extremes(a, length(v), 0.0);
#end
    next_acceleration[i] = acceleration[i];
}
