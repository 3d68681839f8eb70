// Where particles have more than one pass takes back.
#import common/thread
#import common/parameters
#import fields/stay_too

@compute @workgroup_size(GROUP_SIZE)
fn keep_particles_too(thread: Thread) {
    let i = item_index(thread);
    if i < parameters.particle_count {
        stay_too(i);
    }
}
