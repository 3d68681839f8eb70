// Builds the rows' extents by atomic minimum and maximum, then their first voxels by a prefix sum.
#import common/vector
#import common/thread
#import common/parameters
#import common/workgroup_scan
#import cells/grid

const NOTHING_BELOW: i32 = 0x7fffffff;
const NOTHING_ABOVE: i32 = -0x7fffffff;

var<storage, read> next_position: array<Packed>;
// Two values a row: lowest and highest u.
var<storage, read_write> row_bounds: array<atomic<i32>>;
var<storage, read_write> row_record: array<vec2i>;

// The look before the atomic spares nearly all of them: an extent stops growing after its first few particles.
@compute @workgroup_size(GROUP_SIZE)
fn bound_rows(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    let voxel = voxel_of(unpack(next_position[i]));
    let bounds = 2u * u32(third(voxel) + third_size() * voxel.y);
    if voxel.x < atomicLoad(&row_bounds[bounds]) {
        atomicMin(&row_bounds[bounds], voxel.x);
    }
    if voxel.x > atomicLoad(&row_bounds[bounds + 1u]) {
        atomicMax(&row_bounds[bounds + 1u], voxel.x);
    }
}

// First voxel and number of voxels of a row.
fn extent(row: u32) -> vec2i {
    let low = atomicLoad(&row_bounds[2u * row]);
    let high = atomicLoad(&row_bounds[2u * row + 1u]);
    if low > high {
        return vec2i(0);
    }
    return vec2i(low, high - low + 1);
}

// One workgroup; each thread sums a run of rows. Leaves the bounds empty for the next search.
@compute @workgroup_size(SCAN_THREADS)
fn build_rows(@builtin(local_invocation_index) thread: u32) {
    let rows = u32(grid.size.y * third_size());
    let run = (rows + SCAN_THREADS - 1u) / SCAN_THREADS;
    let begin = min(thread * run, rows);
    let end = min(begin + run, rows);
    var voxels = 0u;
    for (var row = begin; row < end; row++) {
        voxels += u32(extent(row).y);
    }
    let sum = workgroup_scan(thread, voxels);
    var first_index = i32(sum.before);
    for (var row = begin; row < end; row++) {
        let size = extent(row);
        row_record[row] = vec2i(first_index, size.x);
        first_index += size.y;
        atomicStore(&row_bounds[2u * row], NOTHING_BELOW);
        atomicStore(&row_bounds[2u * row + 1u], NOTHING_ABOVE);
    }
    if thread == 0u {
        row_record[rows] = vec2i(i32(sum.total), 0);
    }
}
