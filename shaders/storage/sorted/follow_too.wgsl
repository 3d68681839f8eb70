// Where particles have more than one pass takes to their places.
#import common/thread
#import common/parameters
#import fields/follow_too

var<storage, read> origin: array<u32>; // storage/sorted/origin.wgsl

@compute @workgroup_size(GROUP_SIZE)
fn follow_particles_too(thread: Thread) {
    let slot = item_index(thread);
    if slot < parameters.particle_count {
        follow_too(origin[slot], slot);
    }
}
