// Candidates straight from the voxels around a particle.
#import <storage>

fn around(i: u32, x: Vector) -> Coordinate {
    return voxel_of(x);
}
