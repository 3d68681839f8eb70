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
var<storage, read_write> list_length: array<u32>;
var<storage, read_write> listed_position: array<Packed>;

@compute @workgroup_size(GROUP_SIZE)
fn list_candidates(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    let x = unpack(position[i]);
    // Boundary particles ask for the fluid only.
    let wall = is_wall(i);
    let first_slot = i * grid.list_capacity;
    var count = 0u;
    for (var number = 0u; number < IMAGES; number++) {
        var y: Vector;
        if !image(x, number, grid.list_reach, &y) {
            continue;
        }
        let home = voxel_of(y);
        for (var k = 0u; k < RANGES; k++) {
            let range = candidate_range(home, k);
            for (var slot = range.x; slot < range.y; slot++) {
                let j = candidate(slot);
                let wanted = j != i && !(wall && is_wall(j));
                if wanted && within(unpack(position[j]) - y, grid.list_reach) {
                    if count < grid.list_capacity {
                        neighbor_list[first_slot + count] = j;
                    }
                    count += 1u;
                }
            }
        }
    }
    listed_position[i] = pack(x);
    list_length[i] = min(count, grid.list_capacity);
    if count > atomicLoad(&list_state.longest) {
        atomicMax(&list_state.longest, count);
    }
}
