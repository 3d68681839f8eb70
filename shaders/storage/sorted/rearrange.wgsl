// Particles to their places in sorted order, and how many each voxel has.
//
// The file that imports this one says what was sorted: `sorted_voxel(slot)` and `sorted_particle(slot)`.
#import common/thread
#import common/parameters
#import storage/sorted/origin

// Of particles, until the prefix sum.
var<storage, read_write> voxel_start: array<atomic<u32>>;

// A voxel's count is the end of its run less the run's begin: its first and its last particle add their part. Where
// Green 2012 and Rojas 2013 keep begin and end of occupied voxels, the prefix sum over the counts gives empty voxels
// their begin too, so that neighbors in a row are one range.
@compute @workgroup_size(GROUP_SIZE)
fn rearrange_particles(thread: Thread) {
    let slot = item_index(thread);
    if slot >= parameters.particle_count {
        return;
    }
    take_place(sorted_particle(slot), slot);
    let last = parameters.particle_count - 1u;
    let voxel = sorted_voxel(slot);
    if slot == 0u || sorted_voxel(max(slot, 1u) - 1u) != voxel {
        atomicSub(&voxel_start[voxel], slot);
    }
    if slot == last || sorted_voxel(min(slot + 1u, last)) != voxel {
        atomicAdd(&voxel_start[voxel], slot + 1u);
    }
}
