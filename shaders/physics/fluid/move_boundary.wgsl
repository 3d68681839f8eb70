// Boundary particles at the end of a step. Those that never move are left out where no fluid can reach them.
#flag moves
#import common/thread
#import common/parameters
#import physics/time_step
#import physics/fluid/boundary_particles
#import physics/fluid/coefficients
#import physics/fluid/wall_motion
#import physics/fluid/pair_state
#import physics/fluid/next
#import cells/images
#if resting_boundary
#import physics/fluid/numbered
#else
#import fields/position
#end
#if velocity_verlet
#import fields/acceleration
#import fields/next_acceleration/write
#end

@compute @workgroup_size(GROUP_SIZE)
fn move_boundary(thread: Thread) {
#if resting_boundary
    let i = numbered_particle(item_index(thread));
#else
    let i = item_index(thread);
#end
    if i >= parameters.particle_count || !is_boundary(i) {
        return;
    }
    let v = wall_velocity(i);
    let mine = pair_state_at(i);
#if resting_boundary
    let x = unpack(mine.place);
#else
    // Where no fluid is near, the pair state stays as the search left it, while bodies move on.
    let x = unpack(position[i]);
#end
    let moved = wrapped(x + time_step() * v.motion);
    leave_fluid(i, moved, v.motion + v.surface, number_of(mine.place));
#if velocity_verlet
    next_acceleration[i] = acceleration[i];
#end
}
