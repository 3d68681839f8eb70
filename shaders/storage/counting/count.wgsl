// Begins storage `counting`: particles of each voxel.
#import common/thread
#import common/parameters
#import storage/sorted/keys

// Counts, until the prefix sum.
var<storage, read_write> voxel_start: array<atomic<u32>>;
// Voxel of each particle, and how many of the voxel's particles came before it to the counter.
var<storage, read_write> particle_voxel: array<u32>;
var<storage, read_write> arrival: array<u32>;

@compute @workgroup_size(GROUP_SIZE)
fn count_voxels(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    let voxel = sort_key(i);
    particle_voxel[i] = voxel;
    arrival[i] = atomicAdd(&voxel_start[voxel], 1u);
}
