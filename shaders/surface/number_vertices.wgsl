// Number of each edge's vertex, in the order of memory: along u, slice by slice.
#import storage/scan
#import surface/surface

var<storage, read> surface_cell: array<u32>;
var<storage, read_write> vertex_start: array<u32>;
var<storage, read_write> surface_totals: SurfaceTotals;

fn scan_items() -> u32 {
    return surface.voxels;
}

fn scan_value(voxel: u32) -> u32 {
    return countOneBits(surface_cell[voxel] >> 8u);
}

fn scan_result(voxel: u32, before: u32) {
    vertex_start[voxel] = before;
    if voxel + 1u == scan_items() {
        surface_totals.vertices = before + scan_value(voxel);
    }
}
