// The node of each voxel in memory that is near the surface. Many particles mark the same node, with the same numbers.
#import surface/marks
#import <addressing>

var<storage, read_write> surface_node: array<atomic<u32>>;

@compute @workgroup_size(GROUP_SIZE)
fn list_nodes(thread: Thread) {
    let node = next_voxel(thread);
    if !is_followed(node) {
        return;
    }
    let place = 2u * address(node);
    let packed = packed_node(node);
    atomicStore(&surface_node[place], packed.x);
    atomicStore(&surface_node[place + 1u], packed.y);
}
