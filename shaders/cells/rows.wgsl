// Addressing `rows`: each row of each slice has voxels in the extent of its particles only (slices of slices).
#import common/vector
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
    let part = row_part(home, k, 1);
    return part.xy + part.z;
}
