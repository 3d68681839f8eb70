// Addressing `bitmap`: one bit a voxel inside each row's extent; only voxels that hold particles have addresses, by
// their rank among the set bits.
#import common/vector
#import cells/row_table

// The bits of 32 voxels, and how many are set in the words before. One more stands at the end.
var<storage, read> voxel_word: array<vec2u>;

fn voxel_total() -> u32 {
    return voxel_word[row_record[row_count()].x].y;
}

// Set bits before the `bit`-th of a row that begins with word `first`.
fn rank(first: u32, bit: u32) -> u32 {
    let word = voxel_word[first + bit / 32u];
    return word.y + countOneBits(word.x & ((1u << (bit % 32u)) - 1u));
}

// For a voxel that holds a particle.
fn address(v: Coordinate) -> u32 {
    if is_quarantined(v) {
        return voxel_total();
    }
    let row = row_record[row_of(v)];
    return rank(u32(row.x), u32(v.x - row.y));
}

// The voxels of a row around a voxel that hold particles stand side by side in memory.
const SPANS: u32 = ROWS;
const SPAN_VOXELS: u32 = ROW_VOXELS;

// Addresses [first, last) of the voxels of the k-th span around `home`.
fn span(home: Coordinate, k: u32) -> vec2u {
    let part = row_part(home, k, 32);
    return vec2u(rank(part.z, part.x), rank(part.z, part.y));
}
