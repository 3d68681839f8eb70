// Voxel coordinates. Components stand in the order (u, s, w): u runs fastest in memory, s counts slices, w is the
// third one (absent in 2D). With slicing axis y that is (x, y, z).

struct Grid {
    lower: vec4f, // lower corner of voxel 0, in (u, s, w) order, m
    size: vec4i, // voxels of the domain along u, s, w
    low: vec4i, // lowest voxel coordinates that the search follows
    high: vec4i, // one above the highest
    inverse_side: f32, // 1/m; voxels are a little wider than the search needs, so that rounding loses no neighbor
    side: f32, // m
    axis: u32, // that slices are cut across: 0 x, 1 y, 2 z
    capacity: u32, // voxels that the buffers have room for
    row_capacity: u32, // rows that the tables have room for
    word_capacity: u32, // words of 32 voxels that the bitmap has room for
    list_capacity: u32, // neighbors that a list has room for
    frame_steps: u32, // steps of a frame
    list_reach: f32, // of lists, m: the search radius and the skin
    list_move: f32, // square of how far a particle may come from where its list expects it, m²
    reached_capacity: u32, // boundary particles in reach of fluid that there is room for
    list_way: f32, // where lists expect straight paths: square of the way that a particle may go while its list serves, m²
    list_horizon: f32, // the same: how long the first lists look ahead, s
    period: vec4f, // in (x, y, z) order: lengths after which space repeats, m; 0 along directions where it does not
    inverse_period: vec4f, // 1/m; 0 along those directions
    period_lower: vec4f, // lower corner of what repeats, m
}

var<uniform> grid: Grid;

// Neighbors are at most REACH voxels away along each direction (neighbors::Grid).
const ROW_VOXELS: u32 = 2u * REACH + 1u;

#if two_dimensional
const ROWS: u32 = ROW_VOXELS; // rows of voxels around a voxel, its own included

fn permuted(v: Vector) -> Vector {
    return select(v, v.yx, grid.axis == 0u);
}

fn first_of(v: vec4i) -> Coordinate {
    return v.xy;
}

fn row_offset(k: u32) -> Coordinate {
    return vec2i(0, i32(k) - i32(REACH));
}

// w of a voxel and voxels along w.
fn third(v: Coordinate) -> i32 {
    return 0;
}

fn third_size() -> i32 {
    return 1;
}
#else
const ROWS: u32 = ROW_VOXELS * ROW_VOXELS; // rows of voxels around a voxel, its own included

fn permuted(v: Vector) -> Vector {
    return select(select(v, v.yxz, grid.axis == 0u), v.xzy, grid.axis == 2u);
}

fn first_of(v: vec4i) -> Coordinate {
    return v.xyz;
}

fn row_offset(k: u32) -> Coordinate {
    return vec3i(0, i32(k / ROW_VOXELS) - i32(REACH), i32(k % ROW_VOXELS) - i32(REACH));
}

// w of a voxel and voxels along w.
fn third(v: Coordinate) -> i32 {
    return v.z;
}

fn third_size() -> i32 {
    return grid.size.z;
}
#end

#if bounded
// The voxel of a point. Points outside the grid belong to the nearest voxel at its border: clamping never separates
// two points by more voxels than there are between them, so no neighbor is lost.
fn voxel_of(point: Vector) -> Coordinate {
    let scaled = floor((permuted(point) - first(grid.lower)) * grid.inverse_side);
    return Coordinate(clamp(scaled, Vector(0.0), Vector(first_of(grid.size) - Coordinate(1))));
}

fn is_quarantined(v: Coordinate) -> bool {
    return false;
}
#else
// Of a point that the search does not follow; no voxel is near it.
const QUARANTINE: i32 = 0x20000000;

// The voxel of a point, inside the domain or beyond it.
fn voxel_of(point: Vector) -> Coordinate {
    let scaled = floor((permuted(point) - first(grid.lower)) * grid.inverse_side);
    let low = Vector(first_of(grid.low));
    let high = Vector(first_of(grid.high));
    let followed = all(scaled >= low) && all(scaled < high);
    return select(Coordinate(QUARANTINE), Coordinate(clamp(scaled, low, high)), followed);
}

fn is_quarantined(v: Coordinate) -> bool {
    return v.x == QUARANTINE;
}
#end
