// Particles where they are a little earlier or later than the frame, at the velocity that they have.

#import common/thread
#import common/vector
#import fields/velocity
#import fields/position/write
#import render/subframe

var<storage, read> still_position: array<Packed>; // at the time of the frame

@compute @workgroup_size(GROUP_SIZE)
fn move_particles(thread: Thread) {
    let i = item_index(thread);
    if i < subframe.count {
        let still = still_position[i];
        position[i] = pack_with(unpack(still) + subframe.after_s * unpack(velocity[i]), number_of(still));
    }
}
