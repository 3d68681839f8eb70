// Particles keep their places in memory between two searches.
#import common/thread
#import common/parameters
#import storage/place

@compute @workgroup_size(GROUP_SIZE)
fn keep_particles(thread: Thread) {
    let i = item_index(thread);
    if i < parameters.particle_count {
        place(i, i);
    }
}
