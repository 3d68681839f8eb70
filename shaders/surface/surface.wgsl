// What the passes that make a surface are told, and what they count.

// Written by the host between passes (surface::layout). Lengths are metres, places as the search has them.
struct Surface {
    lower: vec4f, // place of node 0
    low: vec4f, // sides of the domain; far away where there are none
    high: vec4f,
    width: f32, // of a voxel
    reach: f32, // of the weights
    radius: f32, // from the particles' weighted mean to the surface
    farthest: f32, // from the nearest particle to the surface
    deep: f32, // particles nearer to the mean of their neighbors lie deep inside
    shell: u32, // particles near the surface
    voxels: u32,
    vertices: u32,
    spacing: f32, // of the particles
    neighbor_reach: f32, // how far away a neighbor may be
    fewest: f32, // particles with fewer neighbors have no part in the surface
    reserved: u32,
}

var<uniform> surface: Surface;

struct SurfaceTotals {
    shell: u32, // particles near the surface
    vertices: u32,
    triangles: u32,
    open: atomic<u32>, // edges through the surface with a cell around them that is not complete
}

// The value of a node that is not near the surface.
const ABSENT: f32 = 3e38;

// A node stands at the lower corner of its voxel. One that nobody marked is (0, 0).
fn packed_node(v: vec3i) -> vec2u {
    return vec2u(u32(v.x + 1) | (u32(v.y) << 16u), u32(v.z));
}

fn is_marked(node: vec2u) -> bool {
    return node.x != 0u;
}

fn node_of(packed: vec2u) -> vec3i {
    return vec3i(vec3u(packed.x & 0xffffu, packed.x >> 16u, packed.y)) - vec3i(1, 0, 0);
}

fn node_place(node: vec3i) -> vec3f {
    return surface.lower.xyz + surface.width * vec3f(node);
}
