// Addressing `rows`: each row of each slice has voxels in the extent of its particles only (slices of slices).
#import common/vector
#import cells/grid

// One record a row: index of its first voxel, and that voxel's u. One more stands at the end; its first value is the
// number of voxels in all.
var<storage, read> row_record: array<vec2i>;

fn row_of(v: Coordinate) -> u32 {
    return u32(third(v) + third_size() * v.y);
}

fn voxel_total() -> u32 {
    return u32(row_record[grid.size.y * third_size()].x);
}

// For a voxel inside its row's extent.
fn address(v: Coordinate) -> u32 {
    let row = row_record[row_of(v)];
    return u32(row.x + v.x - row.y);
}

// A row of voxels around a voxel stands side by side in memory.
const SPANS: u32 = ROWS;
const SPAN_VOXELS: u32 = ROW_VOXELS;

// Addresses [first, last) of the voxels of the k-th span around `home`.
fn span(home: Coordinate, k: u32) -> vec2u {
    let at = home + row_offset(k);
    if at.y < 0 || at.y >= grid.size.y || third(at) < 0 || third(at) >= third_size() {
        return vec2u(0u);
    }
    let index = row_of(at);
    let row = row_record[index];
    let begin = row.x + max(home.x - i32(REACH) - row.y, 0);
    let end = min(row.x + home.x + i32(REACH) + 1 - row.y, row_record[index + 1u].x);
    if begin >= end {
        return vec2u(0u);
    }
    return vec2u(u32(begin), u32(end));
}
