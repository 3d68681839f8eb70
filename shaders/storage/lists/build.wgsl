// Lists each particle's neighbors within the search radius and the skin.
#import common/thread
#import common/parameters
#import common/reach
#import physics/present
#import storage/lists/state
#import storage/lists/row
#import cells/images
#import physics/fluid/boundary_particles
#if floating_bodies
#import physics/fluid/coefficients
#import physics/dfsph/bodies/numbers
#end
#import <storage>
#if sizes
#import common/sizes
#end
#if boundary_in_reach
#import storage/lists/reach_word

// By their place among all boundary particles.
var<storage, read_write> reach_mark: array<atomic<u32>>;
#end

var<storage, read_write> neighbor_list: array<u32>;
#if !lists_every_step
var<storage, read_write> listed_position: array<Packed>;
#end

#if boundary_in_reach
// The look before the atomic spares all but the first particle of the fluid that meets this one most of them.
fn mark_reached(j: u32) {
    let word = (j - parameters.free_count) / 32u;
    if (atomicLoad(&reach_mark[word]) & reach_bit(j)) == 0u {
        atomicOr(&reach_mark[word], reach_bit(j));
    }
}
#end

// Lists those of a range that are near y in a row, beside `count` others; returns how many they are then. In y those are
// counted that stand at the end of the row.
fn list_range(i: u32, row: u32, wall: bool, y: Vector, range: vec2u, count: vec2u) -> vec2u {
    var found = count;
    for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
        let j = candidate(slot);
#if floating_bodies
        // Those of rigid bodies ask for the fluid, and for boundary particles that they touch.
        let wanted = j != i;
        let reach = select(grid.list_reach, fluid.spacing, wall && is_boundary(j));
#else
        // Boundary particles ask for the fluid only.
        let wanted = j != i && !(wall && is_boundary(j));
#if sizes
        let reach = pair_reach(i, j, grid.list_reach);
#else
        let reach = grid.list_reach;
#end
#end
        if wanted && within(unpack(position[j]) - y, reach) {
#if walls_apart
            let behind = is_boundary(j);
            let place = select(found.x, grid.list_capacity - 1u - found.y, behind);
            if found.x + found.y < grid.list_capacity {
                neighbor_list[row + (LIST_HEAD + place) * LIST_LANES] = j;
            }
            found += vec2u(u32(!behind), u32(behind));
#else
            if found.x < grid.list_capacity {
                neighbor_list[row + (LIST_HEAD + found.x) * LIST_LANES] = j;
            }
            found.x += 1u;
#end
#if boundary_in_reach
#if !lists_boundary
            if is_boundary(j) {
                mark_reached(j);
            }
#end
#end
        }
    }
    return found;
}

// Makes the list with this number, that of particle i at x.
fn list_around(i: u32, number: u32, wall: bool, x: Vector) {
    let row = list_row(number);
    let second = second_row();
    var count = vec2u(0u);
    for (var image_number = 0u; image_number < IMAGES; image_number++) {
        var y: Vector;
        if !image(x, image_number, grid.list_reach, &y) {
            continue;
        }
        let home = voxel_of(y);
        for (var k = 0u; k < RANGE_PAIRS; k++) {
            let pair = range_pair(home, k, second);
            count = list_range(i, row, wall, y, pair.xy, count);
#if separated
#if floating_bodies
            count = list_range(i, row, wall, y, pair.zw, count);
#else
            if !wall {
                count = list_range(i, row, false, y, pair.zw, count);
            }
#end
#end
        }
    }
    neighbor_list[row] = min(count.x, grid.list_capacity);
#if walls_apart
    neighbor_list[row + LIST_LANES] = min(count.y, grid.list_capacity - min(count.x, grid.list_capacity));
#end
    let length = count.x + count.y;
    if length > atomicLoad(&list_state.longest) {
        atomicMax(&list_state.longest, length);
    }
}

@compute @workgroup_size(GROUP_SIZE)
fn list_candidates(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    let wall = is_boundary(i);
#if lists_every_step
    if wall {
#if floating_bodies
        let number = member_number(id[i]);
        if number < MEMBERS {
            list_around(i, list_of_member(number, i), true, unpack(position[i]));
        }
#end
        return;
    }
#end
#if boundary_in_reach
    if wall {
        return;
    }
#end
    let x = unpack(position[i]);
#if !lists_every_step
    listed_position[i] = pack(x);
#end
    list_around(i, i, wall, x);
}
