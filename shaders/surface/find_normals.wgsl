// Normals of the mesh, outward: away from a mean of the particles, which is smoother than the gradient of the implicit
// function; on a side of the domain, the side's.
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

fn unit_of(v: vec3f) -> vec3f {
    let length = length(v);
    return select(vec3f(0.0, 1.0, 0.0), v / length, length > 0.0);
}

@compute @workgroup_size(GROUP_SIZE)
fn find_normals(thread: Thread) {
    let vertex = item_index(thread);
    if vertex >= surface.vertices {
        return;
    }
    let x = mesh_position[vertex].xyz;
    let around = around_point(x);
    // Farther particles would turn the normals of drops and strands.
    var normal = mix(unit_of(-around.mean), unit_of(around.outward), crowd(around));
    if beyond_sides(x) > of_particles(around) {
        normal = side_normal(x);
    }
    mesh_normal[vertex] = vec4f(unit_of(normal), 0.0);
}
