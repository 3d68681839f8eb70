// The table of slices.

// One record a slice: index of its first voxel p, lower corner of its box along u and w, voxels along u.
// One more stands at the end; its p is the number of voxels in all.
var<storage, read> slice_record: array<vec4i>;

fn slices() -> i32 {
    return grid.high.y - grid.low.y;
}

#if regions
#import cells/regions

// Region of each column of voxels along u, then along w; none where a column is empty.
var<storage, read> column_region: array<i32>;

fn slice_count() -> i32 {
    return i32(REGIONS) * slices();
}

// Of the slice of a voxel in its region; negative where there is none.
fn slice_index(v: Coordinate) -> i32 {
    if v.x < grid.low.x || v.x >= grid.high.x || v.y < grid.low.y || v.y >= grid.high.y {
        return -1;
    }
    var region = column_region[v.x - grid.low.x];
#if !two_dimensional
    if v.z < grid.low.z || v.z >= grid.high.z {
        return -1;
    }
    let along_w = column_region[columns_along_u() + v.z - grid.low.z];
    region = select(region + i32(REGIONS_ALONG) * along_w, NO_REGION, region < 0 || along_w < 0);
#end
    return select(region * slices() + v.y - grid.low.y, -1, region < 0);
}
#else
fn slice_count() -> i32 {
    return slices();
}

// Of the slice of a voxel; negative where there is none.
fn slice_index(v: Coordinate) -> i32 {
    return select(-1, v.y - grid.low.y, v.y >= grid.low.y && v.y < grid.high.y);
}
#end
