// Where the surface crosses edges: by linear interpolation of the implicit function.
#import surface/cells

var<storage, read> surface_cell: array<u32>;
var<storage, read> vertex_start: array<u32>;
var<storage, read_write> mesh_position: array<vec4f>;

// Share of an edge that vertices keep from its ends, so that no two of them lie upon each other.
const LEAST: f32 = 1e-3;

@compute @workgroup_size(GROUP_SIZE)
fn place_vertices(thread: Thread) {
    let voxel = item_index(thread);
    if voxel >= surface.voxels {
        return;
    }
    let crossed = crossed_edges(surface_cell[voxel]);
    if crossed == 0u {
        return;
    }
    let node = node_of(surface_node[voxel]);
    let value = surface_value[voxel];
    var vertex = vertex_start[voxel];
    for (var axis = 0u; axis < 3u; axis++) {
        if (crossed >> axis & 1u) == 0u {
            continue;
        }
        let other = value_at(node + unit(axis));
        let share = clamp(value / (value - other), LEAST, 1.0 - LEAST);
        let place = node_place(node) + share * surface.width * vec3f(unit(axis));
        mesh_position[vertex] = vec4f(place, 0.0);
        vertex++;
    }
}
