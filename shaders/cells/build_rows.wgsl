// Builds the table of rows: the slices' extents along w and the rows' along u by atomic minimum and maximum, their
// places by prefix sums.
#import common/workgroup_scan
#import <marks>
#import cells/reallocation
#import cells/extent

// Two values a slice: lowest and highest w.
var<storage, read_write> slice_bounds: array<atomic<i32>>;
var<storage, read_write> slice_rows: array<vec2i>;
// Two values a row: lowest and highest u.
var<storage, read_write> row_bounds: array<atomic<i32>>;
var<storage, read_write> row_record: array<vec2i>;

// The look before the atomic spares nearly all of them: an extent stops growing after its first few particles.
@compute @workgroup_size(GROUP_SIZE)
fn bound_slices(thread: Thread) {
    let voxel = next_voxel(thread);
    if !is_followed(voxel) {
        return;
    }
    let bounds = 2u * u32(voxel.y - grid.low.y);
    let w = third(voxel);
    if w < atomicLoad(&slice_bounds[bounds]) {
        atomicMin(&slice_bounds[bounds], w);
    }
    if w > atomicLoad(&slice_bounds[bounds + 1u]) {
        atomicMax(&slice_bounds[bounds + 1u], w);
    }
}

// One workgroup. Leaves the bounds empty for the next search.
@compute @workgroup_size(SCAN_THREADS)
fn place_rows(@builtin(local_invocation_index) thread: u32) {
    let slices = u32(grid.high.y - grid.low.y);
    var rows = 0u;
    for (var base = 0u; base < slices; base += SCAN_THREADS) {
        let s = base + thread;
        var low = 0;
        var count = 0;
        if s < slices {
            let lowest = atomicLoad(&slice_bounds[2u * s]);
            let highest = atomicLoad(&slice_bounds[2u * s + 1u]);
            if lowest <= highest {
                low = lowest;
                count = highest - lowest + 1;
            }
            atomicStore(&slice_bounds[2u * s], NOTHING_BELOW);
            atomicStore(&slice_bounds[2u * s + 1u], NOTHING_ABOVE);
        }
        let sum = workgroup_scan(thread, u32(count));
        if s < slices {
            slice_rows[s] = vec2i(i32(rows + sum.before), low);
        }
        rows += sum.total;
    }
    if thread == 0u {
        var total = 0u;
        if search_state.halted == 0u {
            search_state.rows = rows;
            total = select(0u, rows, fits(rows, grid.row_capacity));
        }
        slice_rows[slices] = vec2i(i32(total), 0);
    }
}

fn row_total() -> u32 {
    let slices = grid.high.y - grid.low.y;
#if two_dimensional
    return u32(slices);
#else
    return u32(slice_rows[slices].x);
#end
}

fn row_of(voxel: Coordinate) -> u32 {
    let s = voxel.y - grid.low.y;
#if two_dimensional
    return u32(s);
#else
    let slice = slice_rows[s];
    return u32(slice.x + voxel.z - slice.y);
#end
}

@compute @workgroup_size(GROUP_SIZE)
fn bound_rows(thread: Thread) {
    let voxel = next_voxel(thread);
    if is_quarantined(voxel) {
        atomicAdd(&search_state.quarantined_so_far, 1u);
    }
    if !is_followed(voxel) {
        return;
    }
    let bounds = 2u * row_of(voxel);
    if voxel.x < atomicLoad(&row_bounds[bounds]) {
        atomicMin(&row_bounds[bounds], voxel.x);
    }
    if voxel.x > atomicLoad(&row_bounds[bounds + 1u]) {
        atomicMax(&row_bounds[bounds + 1u], voxel.x);
    }
}

// First voxel of a row, and how many voxels (in `bitmap`: words of 32) it has.
fn extent(row: u32) -> vec2i {
    let low = atomicLoad(&row_bounds[2u * row]);
    let high = atomicLoad(&row_bounds[2u * row + 1u]);
    if low > high {
        return vec2i(0);
    }
#if bitmap
    return vec2i(low, (high - low + 32) / 32);
#else
    return vec2i(low, high - low + 1);
#end
}

// One workgroup; each thread sums a run of rows. Leaves the bounds empty for the next search.
@compute @workgroup_size(SCAN_THREADS)
fn build_rows(@builtin(local_invocation_index) thread: u32) {
    let rows = row_total();
    let run = (rows + SCAN_THREADS - 1u) / SCAN_THREADS;
    let begin = min(thread * run, rows);
    let end = min(begin + run, rows);
    var items = 0u;
    for (var row = begin; row < end; row++) {
        items += u32(extent(row).y);
    }
    let sum = workgroup_scan(thread, items);
    var first_index = i32(sum.before);
    for (var row = begin; row < end; row++) {
        let size = extent(row);
        row_record[row] = vec2i(first_index, size.x);
        first_index += size.y;
        atomicStore(&row_bounds[2u * row], NOTHING_BELOW);
        atomicStore(&row_bounds[2u * row + 1u], NOTHING_ABOVE);
    }
    if thread == 0u {
#if bitmap
        var total = 0u;
        if search_state.halted == 0u {
            search_state.words = sum.total;
            total = select(0u, sum.total, fits(sum.total, grid.word_capacity));
        }
#else
        let total = select(0u, sum.total, set_voxels(sum.total));
#end
        row_record[rows] = vec2i(i32(total), 0);
    }
}
