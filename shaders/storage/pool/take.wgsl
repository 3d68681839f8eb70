// Particles keep their places.
#import common/thread
#import common/parameters
#import fields/place
#import fields/follow

@compute @workgroup_size(GROUP_SIZE)
fn take_particles(thread: Thread) {
    let i = item_index(thread);
    if i < parameters.particle_count {
        place(i, i);
        follow(i, i);
    }
}
