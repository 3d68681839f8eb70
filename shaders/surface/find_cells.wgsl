// Which cells and edges the surface passes through.
#import surface/cells

var<storage, read_write> surface_cell: array<u32>;
var<storage, read_write> surface_totals: SurfaceTotals;

// Whether the four cells around a node's edge have all of their corners.
fn is_complete(node: Coordinate, axis: u32) -> bool {
    let across = unit((axis + 1u) % 3u);
    let third_way = unit((axis + 2u) % 3u);
    for (var a = -1; a <= 1; a++) {
        for (var b = -1; b <= 1; b++) {
            let at = node + a * across + b * third_way;
            if find(at) == NO_ADDRESS || find(at + unit(axis)) == NO_ADDRESS {
                return false;
            }
        }
    }
    return true;
}

@compute @workgroup_size(GROUP_SIZE)
fn find_cells(thread: Thread) {
    let voxel = item_index(thread);
    if voxel >= surface.voxels {
        return;
    }
    surface_cell[voxel] = 0u;
    if !is_marked(surface_node[voxel]) {
        return;
    }
    let node = node_of(surface_node[voxel]);
    let is_inside = surface_value[voxel] < 0.0;
    var inside = u32(is_inside);
    var absent = 0u;
    for (var number = 1u; number < 8u; number++) {
        let value = value_at(node + corner(number));
        inside |= u32(value < 0.0) << number;
        absent |= u32(value == ABSENT) << number;
    }
    var crossed = 0u;
    for (var axis = 0u; axis < 3u; axis++) {
        let end = 1u << axis;
        if (absent >> end & 1u) != 0u || ((inside >> end & 1u) != 0u) == is_inside {
            continue;
        }
        crossed |= 1u << axis;
        if !is_complete(node, axis) {
            atomicAdd(&surface_totals.open, 1u);
        }
    }
    surface_cell[voxel] = select(0u, inside, absent == 0u) | (crossed << 8u);
}
