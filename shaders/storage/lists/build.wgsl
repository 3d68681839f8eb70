// Lists each particle's neighbors within the search radius and the skin.
#import common/thread
#import common/parameters
#import common/reach
#import physics/present
#import storage/lists/state
#import cells/images
#import physics/fluid/walls
#import <storage>

var<storage, read_write> neighbor_list: array<u32>;
#if !lists_every_step
var<storage, read_write> listed_position: array<Packed>;
#end

// Lists those of a range that are near y, behind `count` others; returns how many they are then.
fn list_range(i: u32, wall: bool, y: Vector, range: vec2u, count: u32) -> u32 {
    var found = count;
    let first_slot = i * (grid.list_capacity + 1u) + 1u;
    for (var slot = range.x; slot < range.y; slot++) {
        let j = candidate(slot);
        // Boundary particles ask for the fluid only.
        let wanted = j != i && !(wall && is_wall(j));
        if wanted && within(unpack(position[j]) - y, grid.list_reach) {
            if found < grid.list_capacity {
                neighbor_list[first_slot + found] = j;
            }
            found += 1u;
        }
    }
    return found;
}

@compute @workgroup_size(GROUP_SIZE)
fn list_candidates(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    let x = unpack(position[i]);
    let wall = is_wall(i);
#if lists_every_step
    if wall {
        return;
    }
#end
    let row = i * (grid.list_capacity + 1u);
    let second = second_row();
    var count = 0u;
    for (var number = 0u; number < IMAGES; number++) {
        var y: Vector;
        if !image(x, number, grid.list_reach, &y) {
            continue;
        }
        let home = voxel_of(y);
        for (var k = 0u; k < RANGE_PAIRS; k++) {
            let pair = range_pair(home, k, second);
            count = list_range(i, wall, y, pair.xy, count);
#if separated
            if !wall {
                count = list_range(i, false, y, pair.zw, count);
            }
#end
        }
    }
#if !lists_every_step
    listed_position[i] = pack(x);
#end
    neighbor_list[row] = min(count, grid.list_capacity);
    if count > atomicLoad(&list_state.longest) {
        atomicMax(&list_state.longest, count);
    }
}
