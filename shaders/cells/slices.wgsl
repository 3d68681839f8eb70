// The table of slices.

// One record a slice: index of its first voxel p, lower corner of its box along u and w, voxels along u.
// One more stands at the end; its p is the number of voxels in all.
var<storage, read> slice_record: array<vec4i>;

fn slice_count() -> u32 {
    return u32(grid.high.y - grid.low.y);
}

// For a voxel that the search follows.
fn slice_index(v: Coordinate) -> u32 {
    return u32(v.y - grid.low.y);
}
