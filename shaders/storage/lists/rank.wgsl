// Behind the lists of the fluid, which mark the boundary particles that they meet: how many of these stand before each word of
// marks, and whether there is room for all of them.
#import common/vector
#import common/parameters
#import common/workgroup_scan
#import cells/grid
#import cells/reallocation

// Bits while they are set; zero between searches.
var<storage, read_write> reach_mark: array<u32>;
var<storage, read_write> reach_word: array<vec2u>;
// Their number stands first (storage/lists/reached.wgsl).
var<storage, read_write> reached: array<u32>;

// One workgroup; each thread sums a run of words. Leaves no mark for the next search.
@compute @workgroup_size(SCAN_THREADS)
fn rank_reached(@builtin(local_invocation_index) thread: u32) {
    let words = (parameters.particle_count - parameters.free_count + 31u) / 32u;
    let run = (words + SCAN_THREADS - 1u) / SCAN_THREADS;
    let begin = min(thread * run, words);
    let end = min(begin + run, words);
    var found = 0u;
    for (var word = begin; word < end; word++) {
        found += countOneBits(reach_mark[word]);
    }
    let sum = workgroup_scan(thread, found);
    var before = sum.before;
    for (var word = begin; word < end; word++) {
        let bits = reach_mark[word];
        reach_word[word] = vec2u(bits, before);
        before += countOneBits(bits);
        reach_mark[word] = 0u;
    }
    // Where an earlier pass found too little room, nothing was marked.
    if thread == 0u && search_state.halted == 0u {
        search_state.reached = sum.total;
        reached[0] = sum.total;
        _ = fits(sum.total, grid.reached_capacity);
    }
}
