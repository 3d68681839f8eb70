// What the passes that lay out a grid begin with: the voxel of each particle that moved.
#import common/vector
#import common/thread
#import common/parameters
#import cells/grid
#import fields/next_position

// Of a thread that has no particle.
const NOBODY: i32 = QUARANTINE + 1;

// The voxel of a thread's particle.
fn next_voxel(thread: Thread) -> Coordinate {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return Coordinate(NOBODY);
    }
    return voxel_of(unpack(next_position[i]));
}

// Whether there is a particle, and the search follows it.
fn is_followed(v: Coordinate) -> bool {
    return v.x < QUARANTINE;
}
