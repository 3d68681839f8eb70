// Ends storage `counting`, behind count.wgsl and the prefix sum (sorted/scan_voxels.wgsl): scatter. Where runs have to be
// repeatable, particles take a canonical order inside each voxel, so that two runs sum in the same order whatever order the
// atomics had.
#import common/thread
#import common/parameters
#import storage/sorted/origin

var<storage, read> voxel_start: array<u32>;
var<storage, read> particle_voxel: array<u32>;
var<storage, read> arrival: array<u32>;
#if deterministic
// Particles in voxel order, inside a voxel in order of arrival.
var<storage, read_write> arrived: array<u32>;
#end

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
    take_place(i, slot);
}
#else
@compute @workgroup_size(GROUP_SIZE)
fn reorder_particles(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    take_place(i, voxel_start[particle_voxel[i]] + arrival[i]);
}
#end
