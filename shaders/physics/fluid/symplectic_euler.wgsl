// Forces, then symplectic Euler (Rojas 2013, Eq. 7).
#import common/thread
#import physics/guard
#import physics/next
#import physics/fluid/forces
#if boundary_particles
#import physics/fluid/wall_motion
#end
#if shifting
#if continuity
var<storage, read_write> next_excess: array<f32>;
#end
#end

@compute @workgroup_size(GROUP_SIZE)
fn move_fluid(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    let x = unpack(position[i]);
#if boundary_particles
    if is_wall(i) {
        leave_wall(i, x);
        return;
    }
#end
    let forces = forces_on(i);
    var v = unpack(velocity[i]) + parameters.time_step * forces.acceleration;
    var moved = x + parameters.time_step * v;
#if shifting
    moved += forces.shift;
    v += forces.velocity_slope * forces.shift;
#if continuity
    next_excess[i] = fluid_state[i].x + dot(forces.excess_slope, forces.shift);
#end
#end
    moved = wrapped(moved);
    watch(id[i], clock.step, x, &moved, &v);
    leave(i, moved, v);
}
