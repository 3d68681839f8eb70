// The centers of the kernels near the surface, in the order of the search.
#import storage/scan
#import common/parameters
#import surface/surface

var<storage, read> shell_flag: array<u32>;
var<storage, read> surface_kernel: array<vec4f>; // KERNEL_VECTORS per particle, the first with its center
var<storage, read_write> shell_position: array<vec4f>;
var<storage, read_write> surface_totals: SurfaceTotals;

fn scan_items() -> u32 {
    return parameters.particle_count;
}

fn scan_value(particle: u32) -> u32 {
    return shell_flag[particle];
}

fn scan_result(particle: u32, before: u32) {
    if shell_flag[particle] != 0u {
        shell_position[before] = surface_kernel[KERNEL_VECTORS * particle];
    }
    if particle + 1u == scan_items() {
        surface_totals.shell = before + shell_flag[particle];
    }
}
