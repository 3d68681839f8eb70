// Number of each cell's first triangle, in the order of memory.
#import storage/scan
#import surface/surface
#import surface/cube_table

var<storage, read> surface_cell: array<u32>;
var<storage, read_write> triangle_start: array<u32>;
var<storage, read_write> surface_totals: SurfaceTotals;

fn scan_items() -> u32 {
    return surface.voxels;
}

fn scan_value(voxel: u32) -> u32 {
    return triangles_of(surface_cell[voxel] & 0xffu);
}

fn scan_result(voxel: u32, before: u32) {
    triangle_start[voxel] = before;
    if voxel + 1u == scan_items() {
        surface_totals.triangles = before + scan_value(voxel);
    }
}
