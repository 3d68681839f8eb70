// First half of a velocity Verlet step (see velocity_verlet.wgsl): positions move, velocities are predicted.
#flag moves
#import common/thread
#import physics/time_step
#import physics/guard
#import physics/fluid/pairs
#import physics/fluid/material
#import physics/fluid/pair_state
#import physics/fluid/next
#if faces
#import physics/fluid/rim
#end
#if adaptive_step
#import physics/fluid/note
#end

var<storage, read> acceleration: array<Packed>;
var<storage, read_write> next_acceleration: array<Packed>;

@compute @workgroup_size(GROUP_SIZE)
fn drift_fluid(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count || is_boundary(i) {
        return;
    }
    let dt = time_step();
    // Velocities have been corrected since.
    let found = pair_state_at(i).place;
    let x = unpack(found);
    let deviation = number_of(found);
    next_acceleration[i] = acceleration[i];
    let a = unpack(acceleration[i]);
    var v = unpack(velocity[i]) + dt * a;
    var moved = wrapped(x + dt * (v - 0.5 * dt * a));
#if faces
    stop_at_faces(FACE, &moved, &v);
#if rim
    keep_within_rim(&moved, &v);
#end
#end
    watch(i, x, &moved, &v);
    leave_fluid(i, moved, v, deviation);
#if adaptive_step
    note_fluid(a, v, deviation);
#end
}
