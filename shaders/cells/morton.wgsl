// Addressing `morton`: the whole box along a Z-order curve (Green 2012; Rojas 2013): blocks whose sides are a power of
// two, bits interleaved inside a block, blocks in rows.
#import common/vector
#import cells/grid

// Leaves a gap of one bit (2D) or two bits (3D) behind each of the lower bits (10 of them in 3D).
#if two_dimensional
fn spread(value: u32) -> u32 {
    var x = value & 0xffffu;
    x = (x | (x << 8u)) & 0x00ff00ffu;
    x = (x | (x << 4u)) & 0x0f0f0f0fu;
    x = (x | (x << 2u)) & 0x33333333u;
    return (x | (x << 1u)) & 0x55555555u;
}

fn interleaved(v: Coordinate) -> u32 {
    return spread(u32(v.x)) | (spread(u32(v.y)) << 1u);
}
#else
fn spread(value: u32) -> u32 {
    var x = value & 0x3ffu;
    x = (x | (x << 16u)) & 0x030000ffu;
    x = (x | (x << 8u)) & 0x0300f00fu;
    x = (x | (x << 4u)) & 0x030c30c3u;
    return (x | (x << 2u)) & 0x09249249u;
}

fn interleaved(v: Coordinate) -> u32 {
    return spread(u32(v.x)) | (spread(u32(v.y)) << 1u) | (spread(u32(v.z)) << 2u);
}
#end

fn voxel_total() -> u32 {
    return grid.capacity;
}

fn address(v: Coordinate) -> u32 {
    // `low.w`: bits of a coordinate inside a block; `high`: blocks along each direction (neighbors::Grid).
    let bits = u32(grid.low.w);
    let mask = Coordinate((1 << bits) - 1);
    let block = v >> vec_bits(bits);
    let index = u32(block.x + grid.high.x * (third(block) + grid.high.z * block.y));
    return (index << (DIMENSIONS * bits)) | interleaved(v & mask);
}

#if two_dimensional
fn vec_bits(bits: u32) -> vec2u {
    return vec2u(bits);
}
#else
fn vec_bits(bits: u32) -> vec3u {
    return vec3u(bits);
}
#end

// Each voxel around a voxel stands alone.
const SPANS: u32 = ROWS * ROW_VOXELS;
const SPAN_VOXELS: u32 = 1u;

// Addresses [first, last) of the voxels of the k-th span around `home`.
fn span(home: Coordinate, k: u32) -> vec2u {
    var voxel = home + row_offset(k / ROW_VOXELS);
    voxel.x += i32(k % ROW_VOXELS) - i32(REACH);
    if any(voxel < Coordinate(0)) || any(voxel >= first_of(grid.size)) {
        return vec2u(0u);
    }
    let at = address(voxel);
    return vec2u(at, at + 1u);
}
