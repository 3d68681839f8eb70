// Takes particles to the same places in their other buffers.
#import common/thread
#import common/parameters
#import fields/stay

@compute @workgroup_size(GROUP_SIZE)
fn keep_particles(thread: Thread) {
    let i = item_index(thread);
    if i < parameters.particle_count {
        stay(i);
    }
}
