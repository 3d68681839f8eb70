// Addressing `rows`: each row of each slice has voxels in the extent of its particles only (slices of slices).
#import common/vector
#import cells/grid
#import cells/row_table

fn voxel_total() -> u32 {
    return u32(row_record[row_count()].x);
}

// For a voxel inside its row's extent.
fn address(v: Coordinate) -> u32 {
    if is_quarantined(v) {
        return voxel_total();
    }
    let row = row_record[row_of(v)];
    return u32(row.x + v.x - row.y);
}

// A row of voxels around a voxel stands side by side in memory.
const SPANS: u32 = ROWS;
const SPAN_VOXELS: u32 = ROW_VOXELS;

// Addresses [first, last) of the voxels of the k-th span around `home`.
fn span(home: Coordinate, k: u32) -> vec2u {
    let index = row_of(home + row_offset(k));
    if index < 0 {
        return vec2u(0u);
    }
    let row = row_record[index];
    let begin = row.x + max(home.x - i32(REACH) - row.y, 0);
    let end = min(row.x + home.x + i32(REACH) + 1 - row.y, row_record[index + 1].x);
    if begin >= end {
        return vec2u(0u);
    }
    return vec2u(u32(begin), u32(end));
}
