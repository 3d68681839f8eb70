// Every particle's neighbors as the search finds them: their number, then their ids, by the particle's slot.
#import common/thread
#import common/parameters
#import common/reach
#import physics/present
#import <candidates>
#if sizes
#import common/sizes
#end

var<storage, read> search_radius: f32;
var<storage, read_write> neighbor_count: array<u32>;
// Slots [first, last) whose neighbors are listed by this pass.
var<storage, read> listed_slots: vec2u;
// Where the list of each slot begins in `neighbor_id`, which holds those of the listed slots.
var<storage, read> neighbor_start: array<u32>;
var<storage, read_write> neighbor_id: array<u32>;

fn reach_of(i: u32, j: u32) -> f32 {
#if sizes
    return pair_reach(i, j, search_radius);
#else
    return search_radius;
#end
}

@compute @workgroup_size(GROUP_SIZE)
fn count_neighbors(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    let x = unpack(position[i]);
    let home = around(i, x);
    var count = 0u;
    for (var k = 0u; k < RANGES; k++) {
        let range = candidate_range(home, k);
        for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
            let j = candidate(slot);
            count += u32(j != i && within(unpack(position[j]) - x, reach_of(i, j)));
        }
    }
    neighbor_count[i] = count;
}

@compute @workgroup_size(GROUP_SIZE)
fn list_neighbors(thread: Thread) {
    let i = listed_slots.x + item_index(thread);
    if i >= listed_slots.y {
        return;
    }
    let x = unpack(position[i]);
    let home = around(i, x);
    var next = neighbor_start[i];
    for (var k = 0u; k < RANGES; k++) {
        let range = candidate_range(home, k);
        for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
            let j = candidate(slot);
            if j != i && within(unpack(position[j]) - x, reach_of(i, j)) {
                neighbor_id[next] = id[j];
                next += 1u;
            }
        }
    }
}
