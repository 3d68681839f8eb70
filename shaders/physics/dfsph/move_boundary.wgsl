// Boundary particles at the end of a step.
#flag moves
#import common/thread
#import common/parameters
#import physics/time_step
#import physics/fluid/boundary_particles
#import physics/fluid/wall_motion
#import cells/images
#import fields/position
#import fields/next_position/write
#import fields/next_velocity/write
#import fields/id
#if floating_bodies
#import physics/dfsph/bodies/numbers
#end

@compute @workgroup_size(GROUP_SIZE)
fn move_boundary(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count || !is_boundary(i) {
        return;
    }
#if floating_bodies
    if member_number(id[i]) < MEMBERS {
        return;
    }
#end
    let v = wall_velocity(i);
    next_position[i] = pack(wrapped(unpack(position[i]) + time_step() * v.motion));
    next_velocity[i] = pack(v.motion + v.surface);
}
