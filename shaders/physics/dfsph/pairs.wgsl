// What the loops go over: a particle's pairs, without boundary particles, whose part is the same in every iteration.
#import common/thread
#import common/parameters
#import physics/fluid/boundary_particles
#import physics/dfsph/loop
#import physics/dfsph/own
#import physics/dfsph/pair_list
#import storage/lists/row
#if boundary_particles
#import physics/dfsph/walls
#end

var<storage, read> id: array<u32>;
var<storage, read> neighbor_list: array<u32>;
var<storage, read> pair_list: array<Pair>;
#if boundary_particles
var<storage, read> walls: array<Walls>;
#end

// First pair of particle i, and the first one behind. From one to the next are LIST_LANES.
fn pairs_of(i: u32) -> vec2u {
    let row = pair_row(i);
    return vec2u(row, row + neighbor_list[list_row(i)] * LIST_LANES);
}
