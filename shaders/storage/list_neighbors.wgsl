// Every particle's neighbors as the search finds them: their number, then their ids, by id.
#import common/thread
#import common/parameters
#import common/reach
#import physics/present
#import <storage>

var<storage, read> search_radius: f32;
// By id: number of neighbors; then where the list begins.
var<storage, read_write> neighbor_count: array<u32>;
var<storage, read> neighbor_start: array<u32>;
var<storage, read_write> neighbor_id: array<u32>;

@compute @workgroup_size(GROUP_SIZE)
fn count_neighbors(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    let x = unpack(position[i]);
    let home = voxel_of(x);
    var count = 0u;
    for (var k = 0u; k < RANGES; k++) {
        let range = candidate_range(home, k);
        for (var slot = range.x; slot < range.y; slot++) {
            let j = candidate(slot);
            count += u32(j != i && within(unpack(position[j]) - x, search_radius));
        }
    }
    neighbor_count[id[i]] = count;
}

@compute @workgroup_size(GROUP_SIZE)
fn list_neighbors(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    let x = unpack(position[i]);
    let home = voxel_of(x);
    var next = neighbor_start[id[i]];
    for (var k = 0u; k < RANGES; k++) {
        let range = candidate_range(home, k);
        for (var slot = range.x; slot < range.y; slot++) {
            let j = candidate(slot);
            if j != i && within(unpack(position[j]) - x, search_radius) {
                neighbor_id[next] = id[j];
                next += 1u;
            }
        }
    }
}
