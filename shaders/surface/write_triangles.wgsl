// Triangles of the cells, by the numbers of their vertices.
#import surface/cells
#import surface/cube_table

var<storage, read> surface_cell: array<u32>;
var<storage, read> vertex_start: array<u32>;
var<storage, read> triangle_start: array<u32>;
var<storage, read_write> mesh_triangle: array<u32>;

// The vertex on an edge of a cell.
fn vertex_on(node: Coordinate, edge: u32) -> u32 {
    let axis = edge / 4u;
    let along = i32(edge & 1u) * unit((axis + 1u) % 3u);
    let owner = find(node + along + i32(edge >> 1u & 1u) * unit((axis + 2u) % 3u));
    let before = crossed_edges(surface_cell[owner]) & ((1u << axis) - 1u);
    return vertex_start[owner] + countOneBits(before);
}

@compute @workgroup_size(GROUP_SIZE)
fn write_triangles(thread: Thread) {
    let voxel = item_index(thread);
    if voxel >= surface.voxels {
        return;
    }
    let corners = corners_inside(surface_cell[voxel]);
    let node = node_of(surface_node[voxel]);
    for (var number = 0u; number < triangles_of(corners); number++) {
        let edges = triangle_edges(corners, number);
        let first = 3u * (triangle_start[voxel] + number);
        for (var k = 0u; k < 3u; k++) {
            mesh_triangle[first + k] = vertex_on(node, edges[k]);
        }
    }
}
