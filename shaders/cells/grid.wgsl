// Voxel coordinates. Components stand in the order (u, s, w): u runs fastest in memory, s counts slices, w is the
// third one (absent in 2D). With slicing axis y that is (x, y, z).

struct Grid {
    lower: vec4f, // lower corner of voxel 0, in (u, s, w) order, m
    size: vec4i, // voxels along u, s, w
    inverse_side: f32, // 1/m; voxels are a little wider than the search radius, so that rounding loses no neighbor
    side: f32, // m
    capacity: u32, // voxels that the buffers have room for
}

var<uniform> grid: Grid;

#if slicing_axis_x
#if two_dimensional
fn permuted(v: Vector) -> Vector {
    return v.yx;
}
#else
fn permuted(v: Vector) -> Vector {
    return v.yxz;
}
#end
#else
#if slicing_axis_z
fn permuted(v: Vector) -> Vector {
    return v.xzy;
}
#else
fn permuted(v: Vector) -> Vector {
    return v;
}
#end
#end

// Neighbors are at most REACH voxels away along each direction (neighbors::Grid).
const ROW_VOXELS: u32 = 2u * REACH + 1u;

#if two_dimensional
const ROWS: u32 = ROW_VOXELS; // rows of voxels around a voxel, its own included

fn grid_size() -> Coordinate {
    return grid.size.xy;
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

fn grid_size() -> Coordinate {
    return grid.size.xyz;
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

// The voxel of a point. Points outside the grid belong to the nearest voxel at its border: clamping never separates
// two points by more voxels than there are between them, so no neighbor is lost.
fn voxel_of(point: Vector) -> Coordinate {
    let scaled = floor((permuted(point) - first(grid.lower)) * grid.inverse_side);
    return Coordinate(clamp(scaled, Vector(0.0), Vector(grid_size() - Coordinate(1))));
}
