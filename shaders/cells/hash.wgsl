// Addressing `hash`: a fixed table of buckets, each of which many voxels of an unbounded space may share (Teschner
// 2003; named by Harada 2007 and Green 2012). What shares a bucket by chance costs time, never a wrong neighbor: the
// distance decides.
//
// Blocks of 4 voxels a side (8 where the reach is 2) are hashed whole, and the lower bits tell the voxels of a block
// apart. Voxels that a search visits differ in their lower bits, so that no two of them share a bucket and no
// particle is met twice.
#import common/vector
#import cells/grid

const BLOCK_BITS: u32 = REACH + 1u;
const BLOCK_MASK: u32 = (1u << BLOCK_BITS) - 1u;

fn voxel_total() -> u32 {
    return grid.capacity;
}

fn bucket(v: Coordinate) -> u32 {
    // Teschner et al. 2003, Section 3.1; the primes are theirs.
    let block = vec3u(vec3i(v.x >> BLOCK_BITS, v.y >> BLOCK_BITS, third(v) >> BLOCK_BITS));
    let key = (block.x * 73856093u) ^ (block.y * 19349663u) ^ (block.z * 83492791u);
    var low = (u32(v.x) & BLOCK_MASK) | ((u32(v.y) & BLOCK_MASK) << BLOCK_BITS);
#if two_dimensional
    let hashed = key << (2u * BLOCK_BITS);
#else
    low |= (u32(v.z) & BLOCK_MASK) << (2u * BLOCK_BITS);
    let hashed = key << (3u * BLOCK_BITS);
#end
    return (hashed | low) & (grid.capacity - 1u); // the capacity is a power of two
}

fn address(v: Coordinate) -> u32 {
    return select(bucket(v), voxel_total(), is_quarantined(v));
}

// Each voxel around a voxel stands alone.
const SPANS: u32 = ROWS * ROW_VOXELS;
const SPAN_VOXELS: u32 = 1u;

// Addresses [first, last) of the voxels of the k-th span around `home`.
fn span(home: Coordinate, k: u32) -> vec2u {
    var voxel = home + row_offset(k / ROW_VOXELS);
    voxel.x += i32(k % ROW_VOXELS) - i32(REACH);
    let at = bucket(voxel);
    return select(vec2u(at, at + 1u), vec2u(0u), is_quarantined(home));
}
