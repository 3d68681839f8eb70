// The rows of each slice, in the extent of the slice's particles along w; a row in the extent of its own along u.
#import cells/grid

#if !two_dimensional
// One record a slice: its first row, and that row's w. One more stands at the end; its first value is the number of
// rows in all.
var<storage, read> slice_rows: array<vec2i>;
#end
// One record a row: index of its first voxel (of its first word of 32 voxels in `bitmap`), and that voxel's u. One
// more stands at the end; its first value is their number in all.
var<storage, read> row_record: array<vec2i>;

fn slice_count() -> i32 {
    return grid.high.y - grid.low.y;
}

#if two_dimensional
fn row_count() -> u32 {
    return u32(slice_count());
}

// Index of a voxel's row; negative where there is none.
fn row_of(v: Coordinate) -> i32 {
    return select(-1, v.y - grid.low.y, v.y >= grid.low.y && v.y < grid.high.y);
}
#else
fn row_count() -> u32 {
    return u32(slice_rows[slice_count()].x);
}

// Index of a voxel's row; negative where there is none.
fn row_of(v: Coordinate) -> i32 {
    let s = v.y - grid.low.y;
    if s < 0 || s >= slice_count() {
        return -1;
    }
    let slice = slice_rows[s];
    let row = slice.x + v.z - slice.y;
    return select(-1, row, v.z >= slice.y && row < slice_rows[s + 1].x);
}
#end

// What is near `home` in the k-th row around it and has memory: voxels [x, y) counted from the row's first one, and z
// the index in the row's record. An index stands for so many voxels.
fn row_part(home: Coordinate, k: u32, voxels: i32) -> vec3u {
    let index = row_of(home + row_offset(k));
    if index < 0 {
        return vec3u(0u);
    }
    let row = row_record[index];
    let begin = max(home.x - i32(REACH) - row.y, 0);
    let end = min(home.x + i32(REACH) + 1 - row.y, voxels * (row_record[index + 1].x - row.x));
    return select(vec3u(0u), vec3u(vec3i(begin, end, row.x)), begin < end);
}
