// Builds the bitmap behind the table of rows (build_rows.wgsl): a bit for each voxel that holds a particle, then the
// number of bits before each word.
#import common/workgroup_scan
#import <marks>
#import cells/reallocation
#import cells/row_table

// Bits while they are set; zero between searches.
var<storage, read_write> voxel_mark: array<atomic<u32>>;
var<storage, read_write> voxel_word: array<vec2u>;

// The look before the atomic spares all but the first particle of a voxel most of them.
@compute @workgroup_size(GROUP_SIZE)
fn mark_voxels(thread: Thread) {
    let voxel = next_voxel(thread);
    if !is_followed(voxel) {
        return;
    }
    let row = row_record[row_of(voxel)];
    let bit = u32(voxel.x - row.y);
    let word = u32(row.x) + bit / 32u;
    let mark = 1u << (bit % 32u);
    if (atomicLoad(&voxel_mark[word]) & mark) == 0u {
        atomicOr(&voxel_mark[word], mark);
    }
}

// One workgroup; each thread sums a run of words. Leaves no mark for the next search.
@compute @workgroup_size(SCAN_THREADS)
fn rank_words(@builtin(local_invocation_index) thread: u32) {
    let words = u32(row_record[row_count()].x);
    let run = (words + SCAN_THREADS - 1u) / SCAN_THREADS;
    let begin = min(thread * run, words);
    let end = min(begin + run, words);
    var voxels = 0u;
    for (var word = begin; word < end; word++) {
        voxels += countOneBits(atomicLoad(&voxel_mark[word]));
    }
    let sum = workgroup_scan(thread, voxels);
    var before = sum.before;
    for (var word = begin; word < end; word++) {
        let bits = atomicLoad(&voxel_mark[word]);
        voxel_word[word] = vec2u(bits, before);
        before += countOneBits(bits);
        atomicStore(&voxel_mark[word], 0u);
    }
    if thread == 0u {
        voxel_word[words] = vec2u(0u, select(0u, sum.total, set_voxels(sum.total)));
    }
}
