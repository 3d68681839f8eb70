// Normals of the mesh: the gradient of the implicit function at its vertices, outward; on a side of the domain, the side's.
#flag surface_normals
#import common/thread
#import surface/implicit

var<storage, read> mesh_position: array<vec4f>;
var<storage, read_write> mesh_normal: array<vec4f>;

// The gradient of the distance from the weighted mean, which itself moves with the point.
fn gradient(around: Around) -> vec3f {
    let away = -around.mean / max(length(around.mean), 1e-20);
    let moved = (around.moment * away - around.slope * dot(around.mean, away)) / around.weight;
    let found = away - moved;
    // The mean turns round where particles are few and lie far apart.
    return select(away, found, dot(found, away) > 0.0);
}

@compute @workgroup_size(GROUP_SIZE)
fn find_normals(thread: Thread) {
    let vertex = item_index(thread);
    if vertex >= surface.vertices {
        return;
    }
    let x = mesh_position[vertex].xyz;
    let around = around_point(x);
    var normal = vec3f(0.0, 1.0, 0.0);
    if around.weight > 0.0 {
        normal = gradient(around);
        if length(around.nearest) - surface.farthest > length(around.mean) - surface.radius {
            normal = -around.nearest;
        }
    }
    let beyond = max(surface.low.xyz - x, x - surface.high.xyz);
    if beyond_sides(x) > of_particles(around) {
        let most = max(max(beyond.x, beyond.y), beyond.z);
        normal = select(vec3f(0.0), select(vec3f(1.0), vec3f(-1.0), x - surface.low.xyz < surface.high.xyz - x), beyond == vec3f(most));
    }
    mesh_normal[vertex] = vec4f(normalize(normal), 0.0);
}
