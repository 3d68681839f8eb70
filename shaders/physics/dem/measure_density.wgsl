// At the end of a frame: the mass of the grains in the block of voxels around each grain, over the block's volume.
#import common/thread
#import common/parameters
#import physics/present
#import physics/measure
#import <candidates>
#import fields/density/write

@compute @workgroup_size(GROUP_SIZE)
fn measure_density(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    let home = voxel_of(unpack(position[i]));
    var around = 0u;
    for (var k = 0u; k < RANGES; k++) {
        let range = candidate_range(home, k);
        for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
            // Some searches offer candidates from elsewhere.
            let away = abs(voxel_of(unpack(position[candidate(slot)])) - home);
            around += u32(all(away <= Coordinate(i32(REACH))));
        }
    }
    density[i] = f32(around) * measure.mass / measure.block_volume;
}
