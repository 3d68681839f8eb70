// Builds storage `counting`: count, (prefix sum: sorted/scan_voxels.wgsl,) scatter. Where runs have to be repeatable,
// particles then take a canonical order inside each voxel, so that two runs sum in the same order whatever order the
// atomics had.
#import common/thread
#import common/parameters
#import storage/place
#import <addressing>

var<storage, read_write> voxel_count: array<atomic<u32>>;
var<storage, read> voxel_start: array<u32>;

// Voxel of each particle, and how many of the voxel's particles came before it to the counter.
var<storage, read_write> particle_voxel: array<u32>;
var<storage, read_write> arrival: array<u32>;
#if deterministic
// Particles in voxel order, inside a voxel in order of arrival.
var<storage, read_write> arrived: array<u32>;
#end

@compute @workgroup_size(GROUP_SIZE)
fn count_voxels(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    let voxel = address(voxel_of(unpack(next_position[i])));
    particle_voxel[i] = voxel;
    arrival[i] = atomicAdd(&voxel_count[voxel], 1u);
}

#if deterministic
@compute @workgroup_size(GROUP_SIZE)
fn scatter_particles(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    arrived[voxel_start[particle_voxel[i]] + arrival[i]] = i;
}

@compute @workgroup_size(GROUP_SIZE)
fn reorder_particles(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    let voxel = particle_voxel[i];
    let begin = voxel_start[voxel];
    let end = voxel_start[voxel + 1u];
    var slot = begin;
    for (var other = begin; other < end; other++) {
        slot += u32(arrived[other] < i);
    }
    place(i, slot);
}
#else
@compute @workgroup_size(GROUP_SIZE)
fn reorder_particles(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    place(i, voxel_start[particle_voxel[i]] + arrival[i]);
}
#end
