// Regions (Harada 2007, Section 7): where particles stand in clusters with empty columns of voxels between them, each
// cluster has slices of its own, so that nobody pays for the space between. Columns are looked at along u and along w. Along
// each there are at most REGIONS_ALONG regions; what is more belongs to the last one.

const NO_REGION: i32 = -1;
#if two_dimensional
const REGIONS: u32 = REGIONS_ALONG;
#else
const REGIONS: u32 = REGIONS_ALONG * REGIONS_ALONG;
#end

// Where columns along w begin in the tables, behind those along u.
fn columns_along_u() -> i32 {
    return grid.high.x - grid.low.x;
}

fn columns_along_w() -> i32 {
    return grid.high.z - grid.low.z;
}
