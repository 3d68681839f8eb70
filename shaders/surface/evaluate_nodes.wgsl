// The implicit function at the nodes near the surface.
#import common/thread
#import surface/implicit

var<storage, read> surface_node: array<vec2u>;
var<storage, read_write> surface_value: array<f32>;

@compute @workgroup_size(GROUP_SIZE)
fn evaluate_nodes(thread: Thread) {
    let voxel = item_index(thread);
    if voxel >= surface.voxels {
        return;
    }
    let node = surface_node[voxel];
    var value = ABSENT;
    if is_marked(node) {
        let x = node_place(node_of(node));
        value = max(value_of(field_at(x)), beyond_sides(x));
    }
    surface_value[voxel] = value;
}
