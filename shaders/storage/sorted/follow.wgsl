// Behind a sort, what particles have besides position and velocity follows them to their places.
#import common/thread
#import common/parameters
#import fields/follow

var<storage, read> origin: array<u32>; // storage/sorted/origin.wgsl

@compute @workgroup_size(GROUP_SIZE)
fn follow_particles(thread: Thread) {
    let slot = item_index(thread);
    if slot < parameters.particle_count {
        follow(origin[slot], slot);
    }
}
