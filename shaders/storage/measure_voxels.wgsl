// How full the voxels are.
#import common/thread
#import <storage>

struct Occupancy {
    voxels: u32, // that have memory
    holding: array<atomic<u32>, 6>, // with 0, 1, 2, 3, 4 and more particles
    beyond_slots: atomic<u32>, // particles that a pool of SLOTS indices a voxel has no room for
}

var<storage, read_write> occupancy_count: Occupancy;
var<workgroup> group_holding: array<atomic<u32>, 6>;

@compute @workgroup_size(GROUP_SIZE)
fn measure_voxels(thread: Thread) {
    let voxel = item_index(thread);
    let total = voxel_total();
    if voxel == 0u {
        occupancy_count.voxels = total;
    }
    if thread.local_index < 6u {
        atomicStore(&group_holding[thread.local_index], 0u);
    }
    workgroupBarrier();
    if voxel < total {
        let particles = occupancy(voxel);
        atomicAdd(&group_holding[min(particles, 5u)], 1u);
        if particles > SLOTS {
            atomicAdd(&occupancy_count.beyond_slots, particles - SLOTS);
        }
    }
    workgroupBarrier();
    if thread.local_index < 6u {
        atomicAdd(&occupancy_count.holding[thread.local_index], atomicLoad(&group_holding[thread.local_index]));
    }
}
