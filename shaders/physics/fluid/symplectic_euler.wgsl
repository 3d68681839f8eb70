// Forces, then symplectic Euler (Rojas 2013, Eq. 7).
#flag moves
#import common/thread
#import physics/time_step
#import physics/guard
#import physics/fluid/forces
#import physics/fluid/next
#if faces
#import physics/fluid/rim
#end
#if adaptive_step
#import physics/fluid/note
#end

@compute @workgroup_size(GROUP_SIZE)
fn move_fluid(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count || is_boundary(i) {
        return;
    }
    let dt = time_step();
    let mine = pair_state_at(i);
    let x = unpack(mine.place);
    var deviation = number_of(mine.place);
    let forces = forces_on(i);
    var v = unpack(mine.motion) + dt * forces.acceleration;
    var moved = x + dt * v;
#if shifting
    let displacement = forces.shifting.displacement;
    moved += displacement;
    v += forces.velocity_gradient.slope * displacement;
    deviation += dot(forces.shifting.deviation_slope, displacement);
#end
    moved = wrapped(moved);
#if faces
    stop_at_faces(FACE, &moved, &v);
#if rim
    keep_within_rim(&moved, &v);
#end
#end
    watch(i, x, &moved, &v);
    leave_fluid(i, moved, v, deviation);
#if adaptive_step
    note_fluid(forces.acceleration, v, deviation);
#end
}
