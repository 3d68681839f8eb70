// Finds the regions: columns that hold particles, and where clusters of them begin, with REGION_GAP empty columns between two
// of them.
#import common/workgroup_scan
#import <marks>
#import cells/regions

// Not zero for a column that holds a particle; along u, then along w. Zero between searches.
var<storage, read_write> column_mark: array<atomic<u32>>;
var<storage, read_write> column_region: array<i32>;

fn mark(column: i32) {
    if atomicLoad(&column_mark[column]) == 0u {
        atomicStore(&column_mark[column], 1u);
    }
}

@compute @workgroup_size(GROUP_SIZE)
fn mark_columns(thread: Thread) {
    let voxel = next_voxel(thread);
    if !is_followed(voxel) {
        return;
    }
    mark(voxel.x - grid.low.x);
#if !two_dimensional
    mark(columns_along_u() + voxel.z - grid.low.z);
#end
}

// Whether a cluster begins at a column that holds a particle.
fn begins(first: i32, column: i32) -> bool {
    var found = false;
    for (var gap = 1; gap <= i32(REGION_GAP) && column - gap >= first; gap++) {
        found = found || atomicLoad(&column_mark[column - gap]) != 0u;
    }
    return !found;
}

// Numbers the clusters among the columns [first, end).
fn number_clusters(thread: u32, first: i32, end: i32) {
    var before = 0u;
    for (var base = first; base < end; base += i32(SCAN_THREADS)) {
        let column = base + i32(thread);
        var holds = false;
        var start = 0u;
        if column < end {
            holds = atomicLoad(&column_mark[column]) != 0u;
            start = u32(holds && begins(first, column));
        }
        let sum = workgroup_scan(thread, start);
        if column < end {
            let cluster = before + sum.before + start - 1u;
            column_region[column] = select(NO_REGION, i32(min(cluster, REGIONS_ALONG - 1u)), holds);
        }
        before += sum.total;
    }
}

// One workgroup. Leaves no mark for the next search.
@compute @workgroup_size(SCAN_THREADS)
fn split_regions(@builtin(local_invocation_index) thread: u32) {
    let along_u = columns_along_u();
    var end = along_u;
    number_clusters(thread, 0, along_u);
#if !two_dimensional
    end += columns_along_w();
    number_clusters(thread, along_u, end);
#end
    storageBarrier();
    for (var column = i32(thread); column < end; column += i32(SCAN_THREADS)) {
        atomicStore(&column_mark[column], 0u);
    }
}
