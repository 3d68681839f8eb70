// Builds storage `pool`. Particles keep their places. Where runs have to be repeatable, each voxel keeps the SLOTS
// lowest of its particles' indices in ascending order, whatever order the atomics had: each slot keeps the lower of
// two indices and hands on the other. Otherwise slots go by order of arrival (Green 2012).
#import common/thread
#import common/parameters
#import fields/position
#import <addressing>

const NOBODY: u32 = 0xffffffffu;

struct Overflow {
    now: atomic<u32>, // particles without a slot in this search
    since_last_frame: atomic<u32>, // the same, summed over the searches since the host last looked
}

var<storage, read_write> voxel_count: array<atomic<u32>>;
#if deterministic
var<storage, read_write> index_pool: array<atomic<u32>>;
#else
var<storage, read_write> index_pool: array<u32>;
#end
var<storage, read_write> overflow: Overflow;

// A workgroup empties a block of voxels.
@compute @workgroup_size(SCAN_THREADS)
fn clear_voxels(thread: Thread) {
    let begin = group_index(thread) * SCAN_THREADS * SCAN_ITEMS;
    let end = min(begin + SCAN_THREADS * SCAN_ITEMS, voxel_total());
    if begin + thread.local_index == 0u {
        atomicStore(&overflow.now, 0u);
    }
    for (var voxel = begin + thread.local_index; voxel < end; voxel += SCAN_THREADS) {
        atomicStore(&voxel_count[voxel], 0u);
#if deterministic
        for (var slot = voxel * SLOTS; slot < (voxel + 1u) * SLOTS; slot++) {
            atomicStore(&index_pool[slot], NOBODY);
        }
#end
    }
}

@compute @workgroup_size(GROUP_SIZE)
fn insert_particles(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    let at = voxel_of(unpack(position[i]));
    if is_quarantined(at) {
        return;
    }
    let voxel = address(at);
    let before = atomicAdd(&voxel_count[voxel], 1u);
#if deterministic
    var carried = i;
    for (var slot = voxel * SLOTS; slot < (voxel + 1u) * SLOTS && carried != NOBODY; slot++) {
        carried = max(carried, atomicMin(&index_pool[slot], carried));
    }
#else
    if before < SLOTS {
        index_pool[voxel * SLOTS + before] = i;
    }
#end
    // As many are without a slot as came when all slots were taken, whoever they are.
    if before >= SLOTS {
        atomicAdd(&overflow.now, 1u);
        atomicAdd(&overflow.since_last_frame, 1u);
    }
}
