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
#import storage/lists/listed
var<storage, read_write> listed: array<Listed>;
#end

fn place_of(j: u32) -> Vector {
#if lists_boundary
    return unpack(listed[j].place);
#else
    return unpack(position[j]);
#end
}

#if straight_paths
fn motion_of(j: u32) -> Vector {
#if lists_boundary
    return unpack(listed[j].motion);
#else
    return select(unpack(velocity[j]), Vector(0.0), is_boundary(j));
#end
}

// Keeps a quotient finite, m²/s².
const SLOWEST_SQUARE: f32 = 1e-30;

// Whether a particle at s comes near while it moves at u, both relative to the one whose list is made.
fn comes_near(s: Vector, u: Vector) -> bool {
    let square = max(dot(u, u), SLOWEST_SQUARE);
    let nearest = clamp(-dot(s, u) / square, 0.0, list_horizon());
    return within(s + nearest * u, grid.list_reach);
}

// How far lists look, m.
fn looked() -> f32 {
    return f32(REACH) * grid.side;
}
#else
fn looked() -> f32 {
    return grid.list_reach;
}
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

// Lists in a row, beside `count` others, those of a range that are near y, where particle i or an image of it moves at v; returns
// how many there are then, in y those that stand at the end of the row.
fn list_range(i: u32, row: u32, wall: bool, y: Vector, v: Vector, range: vec2u, count: vec2u) -> vec2u {
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
        let s = place_of(j) - y;
#if straight_paths
        if wanted && within(s, looked()) && (within(s, reach) || comes_near(s, motion_of(j) - v)) {
#else
        if wanted && within(s, reach) {
#end
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
fn list_around(i: u32, number: u32, wall: bool, x: Vector, v: Vector) {
    let row = list_row(number);
    let second = second_row();
    var count = vec2u(0u);
    for (var image_number = 0u; image_number < IMAGES; image_number++) {
        var y: Vector;
        if !image(x, image_number, looked(), &y) {
            continue;
        }
        let home = voxel_of(y);
        for (var k = 0u; k < RANGE_PAIRS; k++) {
            let pair = range_pair(home, k, second);
            count = list_range(i, row, wall, y, v, pair.xy, count);
#if separated
#if floating_bodies
            count = list_range(i, row, wall, y, v, pair.zw, count);
#else
            if !wall {
                count = list_range(i, row, false, y, v, pair.zw, count);
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
            list_around(i, list_of_member(number, i), true, unpack(position[i]), Vector(0.0));
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
    var v = Vector(0.0);
#if straight_paths
    v = motion_of(i);
    listed[i] = Listed(pack(x), pack(v));
#else
#if !lists_every_step
    listed[i] = Listed(pack(x));
#end
#end
    list_around(i, i, wall, x, v);
}
