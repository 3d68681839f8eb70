// Builds storage `pool`. Particles keep their places; each voxel keeps the SLOTS lowest of its particles' indices in
// ascending order, whatever order the atomics had: each slot keeps the lower of two indices and hands on the other.
#import common/thread
#import common/parameters
#import <addressing>

const NOBODY: u32 = 0xffffffffu;

struct Overflow {
    now: atomic<u32>, // particles without a slot in this search
    since_last_frame: atomic<u32>, // the same, summed over the searches since the host last looked
}

var<storage, read_write> voxel_count: array<atomic<u32>>;
var<storage, read_write> index_pool: array<atomic<u32>>;
var<storage, read_write> overflow: Overflow;

var<storage, read> next_position: array<Packed>;
var<storage, read> next_velocity: array<Packed>;
var<storage, read> next_id: array<u32>;
#if accelerations
var<storage, read> next_acceleration: array<Packed>;
var<storage, read_write> acceleration: array<Packed>;
#end
var<storage, read_write> position: array<Packed>;
var<storage, read_write> velocity: array<Packed>;
var<storage, read_write> id: array<u32>;

@compute @workgroup_size(GROUP_SIZE)
fn clear_voxels(thread: Thread) {
    let voxel = item_index(thread);
    if voxel == 0u {
        atomicStore(&overflow.now, 0u);
    }
    if voxel >= voxel_total() {
        return;
    }
    atomicStore(&voxel_count[voxel], 0u);
    for (var slot = voxel * SLOTS; slot < (voxel + 1u) * SLOTS; slot++) {
        atomicStore(&index_pool[slot], NOBODY);
    }
}

@compute @workgroup_size(GROUP_SIZE)
fn insert_particles(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    position[i] = next_position[i];
    velocity[i] = next_velocity[i];
    id[i] = next_id[i];
#if accelerations
    acceleration[i] = next_acceleration[i];
#end
    let voxel = address(voxel_of(unpack(next_position[i])));
    atomicAdd(&voxel_count[voxel], 1u);
    var carried = i;
    for (var slot = voxel * SLOTS; slot < (voxel + 1u) * SLOTS && carried != NOBODY; slot++) {
        carried = max(carried, atomicMin(&index_pool[slot], carried));
    }
    if carried != NOBODY {
        atomicAdd(&overflow.now, 1u);
        atomicAdd(&overflow.since_last_frame, 1u);
    }
}
