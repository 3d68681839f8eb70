// Where particles have more than one pass takes along.
#import common/thread
#import common/parameters
#import fields/follow_too

@compute @workgroup_size(GROUP_SIZE)
fn take_particles_too(thread: Thread) {
    let i = item_index(thread);
    if i < parameters.particle_count {
        follow_too(i, i);
    }
}
