// Addressing `sliced`: each slice has voxels in the bounding box of its particles only (Harada 2007, Eq. 1 to 5).
#import common/vector
#import cells/grid
#import cells/slices

fn voxel_total() -> u32 {
    return u32(slice_record[slice_count()].x);
}

// Eq. 5, for a voxel inside its slice's box.
fn address(v: Coordinate) -> u32 {
    if is_quarantined(v) {
        return voxel_total();
    }
    let slice = slice_record[slice_index(v)];
    return u32(slice.x + (v.x - slice.y) + (third(v) - slice.z) * slice.w);
}

// A row of voxels around a voxel stands side by side in memory.
const SPANS: u32 = ROWS;
const SPAN_VOXELS: u32 = ROW_VOXELS;

// Addresses [first, last) of the voxels of the k-th span around `home`.
fn span(home: Coordinate, k: u32) -> vec2u {
    let row = home + row_offset(k);
    let index = slice_index(row);
    if index < 0 {
        return vec2u(0u);
    }
    let slice = slice_record[index];
    let end_of_slice = slice_record[index + 1].x;
    let base = slice.x + (third(row) - slice.z) * slice.w;
    let begin = max(home.x - i32(REACH) - slice.y, 0);
    let end = min(home.x + i32(REACH) + 1 - slice.y, slice.w);
    if third(row) < slice.z || base >= end_of_slice || begin >= end {
        return vec2u(0u);
    }
    return vec2u(u32(base + begin), u32(base + end));
}
