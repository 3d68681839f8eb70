// What sorted storages sort by: voxels, in the order of their addresses, with the quarantine behind them. Boundary particles
// (flag `separated`) stand behind all others, in a second row of the same voxels.
#import common/vector
#import common/parameters
#import fields/next_position
#import storage/sorted/entries
#import <addressing>
#if separated
#import fields/next_id
#end

// Of the particle that a step left in place i.
fn sort_key(i: u32) -> u32 {
    let voxel = address(voxel_of(unpack(next_position[i])));
#if separated
    return voxel + select(0u, row_length(voxel_total()), next_id[i] >= parameters.first_boundary);
#else
    return voxel;
#end
}
