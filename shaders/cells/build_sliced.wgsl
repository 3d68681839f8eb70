// Builds the slices (Harada 2007, Section 5): bounding boxes by atomic minimum and maximum, then first indices by a
// prefix sum over the slices' voxel counts (Eq. 3).
#import common/workgroup_scan
#import <marks>
#import cells/reallocation
#import cells/extent
#if regions
#import cells/regions
#end

// Four values a slice: lowest u, lowest w, highest u, highest w.
var<storage, read_write> slice_bounds: array<atomic<i32>>;
var<storage, read_write> slice_record: array<vec4i>;
#if regions
var<storage, read> column_region: array<i32>;

fn slice_count() -> u32 {
    return REGIONS * u32(grid.high.y - grid.low.y);
}

// For a voxel that holds a particle.
fn slice_index(v: Coordinate) -> u32 {
    var region = column_region[v.x - grid.low.x];
#if !two_dimensional
    region += i32(REGIONS_ALONG) * column_region[columns_along_u() + v.z - grid.low.z];
#end
    return u32(region * (grid.high.y - grid.low.y) + v.y - grid.low.y);
}
#else
fn slice_count() -> u32 {
    return u32(grid.high.y - grid.low.y);
}

fn slice_index(v: Coordinate) -> u32 {
    return u32(v.y - grid.low.y);
}
#end

fn lower_to(index: u32, value: i32) {
    if value < atomicLoad(&slice_bounds[index]) {
        atomicMin(&slice_bounds[index], value);
    }
}

fn raise_to(index: u32, value: i32) {
    if value > atomicLoad(&slice_bounds[index]) {
        atomicMax(&slice_bounds[index], value);
    }
}

// The look before the atomic spares nearly all of them: a box stops growing after its first few particles.
@compute @workgroup_size(GROUP_SIZE)
fn bound_slices(thread: Thread) {
    let voxel = next_voxel(thread);
    if is_quarantined(voxel) {
        atomicAdd(&search_state.quarantined_so_far, 1u);
    }
    if !is_followed(voxel) {
        return;
    }
    let bounds = 4u * slice_index(voxel);
    lower_to(bounds, voxel.x);
    lower_to(bounds + 1u, third(voxel));
    raise_to(bounds + 2u, voxel.x);
    raise_to(bounds + 3u, third(voxel));
}

// One workgroup. Leaves the bounds empty for the next search.
@compute @workgroup_size(SCAN_THREADS)
fn build_slices(@builtin(local_invocation_index) thread: u32) {
    let slices = slice_count();
    var first_index = 0u;
    for (var base = 0u; base < slices; base += SCAN_THREADS) {
        let s = base + thread;
        var lower = vec2i(0);
        var size = vec2i(0);
        if s < slices {
            let low = vec2i(atomicLoad(&slice_bounds[4u * s]), atomicLoad(&slice_bounds[4u * s + 1u]));
            let high = vec2i(atomicLoad(&slice_bounds[4u * s + 2u]), atomicLoad(&slice_bounds[4u * s + 3u]));
            if low.x <= high.x {
                lower = low;
                size = high - low + vec2i(1); // Eq. 1 and 2
            }
            atomicStore(&slice_bounds[4u * s], NOTHING_BELOW);
            atomicStore(&slice_bounds[4u * s + 1u], NOTHING_BELOW);
            atomicStore(&slice_bounds[4u * s + 2u], NOTHING_ABOVE);
            atomicStore(&slice_bounds[4u * s + 3u], NOTHING_ABOVE);
        }
        let sum = workgroup_scan(thread, u32(size.x * size.y));
        if s < slices {
            slice_record[s] = vec4i(i32(first_index + sum.before), lower, size.x);
        }
        first_index += sum.total;
    }
    if thread == 0u {
        let total = select(0u, first_index, set_voxels(first_index));
        slice_record[slices] = vec4i(i32(total), 0, 0, 0);
    }
}
