// Builds storage `bitonic` (Rojas 2013): a bitonic merge sort of pairs of voxel and particle.
//
// Sorted runs are merged two by two. A merge first compares mirrored items (the first with the last, the second with
// the last but one, …), then items at half the distance, a quarter, and so on. All comparisons put the earlier pair
// first, so the places behind the last particle, up to the next power of two, act as pairs that come last of all
// without being there. Distances inside a block of SORT_BLOCK items are done together in workgroup memory.
#import common/thread
#import common/parameters
#import common/pass_index
#import storage/bitonic/pair
#import storage/sorted/rearrange
#import storage/sorted/keys

var<storage, read_write> sort_pairs: array<Pair>;

var<workgroup> block: array<Pair, SORT_BLOCK>;

// Lower item of the k-th comparison at a distance.
fn lower_item(k: u32, distance: u32) -> u32 {
    return (k / distance) * 2u * distance + k % distance;
}

// The item that it is compared with.
fn upper_item(k: u32, distance: u32, mirrored: bool) -> u32 {
    let begin = (k / distance) * 2u * distance;
    let offset = k % distance;
    return begin + select(distance + offset, 2u * distance - 1u - offset, mirrored);
}

fn compare_in_block(thread: u32, distance: u32, mirrored: bool) {
    workgroupBarrier();
    for (var k = thread; k < SORT_BLOCK / 2u; k += SORT_THREADS) {
        let lower = lower_item(k, distance);
        let upper = upper_item(k, distance, mirrored);
        let a = block[lower];
        let b = block[upper];
        if is_before(b, a) {
            block[lower] = b;
            block[upper] = a;
        }
    }
}

fn load_block(thread: u32, begin: u32) {
    for (var k = thread; k < SORT_BLOCK; k += SORT_THREADS) {
        var pair = LAST_OF_ALL;
        if begin + k < parameters.particle_count {
            pair = sort_pairs[begin + k];
        }
        block[k] = pair;
    }
}

// Writes the block back where there are particles.
fn store_block(thread: u32, begin: u32) {
    workgroupBarrier();
    for (var k = thread; k < SORT_BLOCK; k += SORT_THREADS) {
        if begin + k < parameters.particle_count {
            sort_pairs[begin + k] = block[k];
        }
    }
}

@compute @workgroup_size(GROUP_SIZE)
fn write_pairs(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    sort_pairs[i] = pair_of(sort_key(i), i);
}

// Sorts each block by itself.
@compute @workgroup_size(SORT_THREADS)
fn sort_blocks(thread: Thread) {
    let begin = group_index(thread) * SORT_BLOCK;
    if begin >= parameters.particle_count {
        return;
    }
    load_block(thread.local_index, begin);
    for (var sorted = 1u; sorted < SORT_BLOCK; sorted *= 2u) {
        compare_in_block(thread.local_index, sorted, true);
        for (var distance = sorted / 2u; distance > 0u; distance /= 2u) {
            compare_in_block(thread.local_index, distance, false);
        }
    }
    store_block(thread.local_index, begin);
}

// One comparison a thread, farther than a block: at a distance of 2^(pass_index / 2), mirrored where it is odd.
@compute @workgroup_size(GROUP_SIZE)
fn compare_far(thread: Thread) {
    let distance = 1u << (pass_index / 2u);
    let lower = lower_item(item_index(thread), distance);
    let upper = upper_item(item_index(thread), distance, pass_index % 2u == 1u);
    if upper >= parameters.particle_count {
        return;
    }
    let a = sort_pairs[lower];
    let b = sort_pairs[upper];
    if is_before(b, a) {
        sort_pairs[lower] = b;
        sort_pairs[upper] = a;
    }
}

// All distances inside a block.
@compute @workgroup_size(SORT_THREADS)
fn merge_blocks(thread: Thread) {
    let begin = group_index(thread) * SORT_BLOCK;
    if begin >= parameters.particle_count {
        return;
    }
    load_block(thread.local_index, begin);
    for (var distance = SORT_BLOCK / 2u; distance > 0u; distance /= 2u) {
        compare_in_block(thread.local_index, distance, false);
    }
    store_block(thread.local_index, begin);
}

fn sorted_voxel(slot: u32) -> u32 {
    return voxel_in(sort_pairs[slot]);
}

fn sorted_particle(slot: u32) -> u32 {
    return particle_in(sort_pairs[slot]);
}
