// Builds storage `radix` (Green 2012, "Building the Grid using Sorting"): a stable radix sort, lowest digit first.
// For each digit: count how often each run has it, (prefix sum: scan_digits.wgsl,) and move each run's pairs to where
// the sum says, in order. Stable passes leave a voxel's particles in the order that they had before.
#import common/thread
#import common/pass_index
#import storage/radix/runs
#import storage/sorted/rearrange
#import storage/sorted/keys

// Pairs of voxel and particle, twice: a digit's pass reads one half and writes the other.
var<storage, read_write> sort_pairs: array<vec2u>;
// How many pairs of each run have a digit, all runs of digit 0 first; then, where they begin.
var<storage, read_write> digit_count: array<u32>;

// One column a thread.
var<workgroup> column: array<u32, GROUP_SIZE * DIGITS>;

// Begin of the half that the pass of this number reads.
fn half_of(pass_number: u32) -> u32 {
    return (pass_number % 2u) * (arrayLength(&sort_pairs) / 2u);
}

fn digit_of(voxel: u32) -> u32 {
    return (voxel >> (DIGIT_BITS * pass_index)) % DIGITS;
}

@compute @workgroup_size(GROUP_SIZE)
fn write_pairs(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    sort_pairs[i] = vec2u(sort_key(i), i);
}

@compute @workgroup_size(GROUP_SIZE)
fn count_digits(thread: Thread) {
    let run = item_index(thread);
    if run >= runs() {
        return;
    }
    for (var digit = 0u; digit < DIGITS; digit++) {
        column[digit * GROUP_SIZE + thread.local_index] = 0u;
    }
    let source = half_of(pass_index);
    let end = min((run + 1u) * RUN, parameters.particle_count);
    for (var i = run * RUN; i < end; i++) {
        column[digit_of(sort_pairs[source + i].x) * GROUP_SIZE + thread.local_index] += 1u;
    }
    for (var digit = 0u; digit < DIGITS; digit++) {
        digit_count[digit * runs() + run] = column[digit * GROUP_SIZE + thread.local_index];
    }
}

@compute @workgroup_size(GROUP_SIZE)
fn scatter_pairs(thread: Thread) {
    let run = item_index(thread);
    if run >= runs() {
        return;
    }
    for (var digit = 0u; digit < DIGITS; digit++) {
        column[digit * GROUP_SIZE + thread.local_index] = digit_count[digit * runs() + run];
    }
    let source = half_of(pass_index);
    let target_half = half_of(pass_index + 1u);
    let end = min((run + 1u) * RUN, parameters.particle_count);
    for (var i = run * RUN; i < end; i++) {
        let pair = sort_pairs[source + i];
        let cell = digit_of(pair.x) * GROUP_SIZE + thread.local_index;
        let slot = column[cell];
        column[cell] = slot + 1u;
        sort_pairs[target_half + slot] = pair;
    }
}

// For `rearrange_particles`, whose number is one more than the last digit's.
fn sorted_voxel(slot: u32) -> u32 {
    return sort_pairs[half_of(pass_index) + slot].x;
}

fn sorted_particle(slot: u32) -> u32 {
    return sort_pairs[half_of(pass_index) + slot].y;
}
