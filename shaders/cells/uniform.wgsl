// Addressing `uniform`: the whole box has voxels (Green 2012; the baseline of Harada 2007).
#import common/vector
#import cells/grid

fn voxel_total() -> u32 {
    return grid.capacity;
}

fn address(v: Coordinate) -> u32 {
    return u32(v.x + grid.size.x * (third(v) + third_size() * v.y));
}

// A row of voxels around a voxel stands side by side in memory.
const SPANS: u32 = ROWS;
const SPAN_VOXELS: u32 = ROW_VOXELS;

// Addresses [first, last) of the voxels of the k-th span around `home`.
fn span(home: Coordinate, k: u32) -> vec2u {
    let row = home + row_offset(k);
    if row.y < 0 || row.y >= grid.size.y || third(row) < 0 || third(row) >= third_size() {
        return vec2u(0u);
    }
    let base = grid.size.x * (third(row) + third_size() * row.y);
    let begin = max(home.x - i32(REACH), 0);
    let end = min(home.x + i32(REACH) + 1, grid.size.x);
    return vec2u(u32(base + begin), u32(base + end));
}
