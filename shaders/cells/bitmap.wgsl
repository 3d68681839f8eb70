// Addressing `bitmap`: one bit a voxel inside each row's extent; only voxels that hold particles have addresses, by
// their rank among the set bits.
#import common/vector
#import cells/grid
#import cells/row_table

// The bits of 32 voxels, and how many are set in the words before. One more stands at the end.
var<storage, read> voxel_word: array<vec2u>;

fn voxel_total() -> u32 {
    return voxel_word[row_record[row_count()].x].y;
}

// Set bits before the `bit`-th of a row that begins with word `first`.
fn rank(first: i32, bit: u32) -> u32 {
    let word = voxel_word[u32(first) + bit / 32u];
    return word.y + countOneBits(word.x & ((1u << (bit % 32u)) - 1u));
}

// For a voxel that holds a particle.
fn address(v: Coordinate) -> u32 {
    if is_quarantined(v) {
        return voxel_total();
    }
    let row = row_record[row_of(v)];
    return rank(row.x, u32(v.x - row.y));
}

// The voxels of a row around a voxel that hold particles stand side by side in memory.
const SPANS: u32 = ROWS;
const SPAN_VOXELS: u32 = ROW_VOXELS;

// Addresses [first, last) of the voxels of the k-th span around `home`.
fn span(home: Coordinate, k: u32) -> vec2u {
    let index = row_of(home + row_offset(k));
    if index < 0 {
        return vec2u(0u);
    }
    let row = row_record[index];
    let bits = 32 * (row_record[index + 1].x - row.x);
    let begin = max(home.x - i32(REACH) - row.y, 0);
    let end = min(home.x + i32(REACH) + 1 - row.y, bits);
    if begin >= end {
        return vec2u(0u);
    }
    return vec2u(rank(row.x, u32(begin)), rank(row.x, u32(end)));
}
