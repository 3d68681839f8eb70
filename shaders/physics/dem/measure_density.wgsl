// At the end of a frame: the mass of the grains in the block of voxels around each grain, over the block's volume.
#import common/thread
#import common/parameters
#import physics/present
#import physics/measure
#import <candidates>
#if sizes
#import common/sizes
#end
#import fields/density/write

@compute @workgroup_size(GROUP_SIZE)
fn measure_density(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    let home = voxel_of(unpack(position[i]));
#if sizes
    var around = 0.0;
#else
    var around = 0u;
#end
    for (var k = 0u; k < RANGES; k++) {
        let range = candidate_range(home, k);
        for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
            // Some searches offer candidates from elsewhere.
            let away = abs(voxel_of(unpack(position[candidate(slot)])) - home);
            let is_around = all(away <= Coordinate(i32(REACH)));
#if sizes
            around += select(0.0, mass_share(size_of(candidate(slot))), is_around);
#else
            around += u32(is_around);
#end
        }
    }
    density[i] = f32(around) * measure.mass / measure.block_volume;
}
