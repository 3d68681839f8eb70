// Normals of the mesh, outward; on a side of the domain, the side's.
#import common/thread
#import surface/implicit

var<storage, read> mesh_position: array<vec4f>;
var<storage, read_write> mesh_normal: array<vec4f>;

// The normal of the side of the domain that a point is on.
fn side_normal(x: vec3f) -> vec3f {
    let beyond = max(surface.low.xyz - x, x - surface.high.xyz);
    let most = max(max(beyond.x, beyond.y), beyond.z);
    let outward = select(vec3f(1.0), vec3f(-1.0), nearer_side(x) == surface.low.xyz);
    return select(vec3f(0.0), outward, beyond == vec3f(most));
}

@compute @workgroup_size(GROUP_SIZE)
fn find_normals(thread: Thread) {
    let vertex = item_index(thread);
    if vertex >= surface.vertices {
        return;
    }
    let x = mesh_position[vertex].xyz;
    let field = field_at(x);
    var normal = outward_of(field);
    if beyond_sides(x) > value_of(field) {
        normal = side_normal(x);
    }
    mesh_normal[vertex] = vec4f(unit_of(normal), 0.0);
}
