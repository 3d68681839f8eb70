// What the voxels of a surface's grid are laid out by: the nodes near the particles near the surface. Wherever the implicit
// function is negative a particle is no farther than `farthest`; so the cells around each edge through the surface have all
// of their corners one voxel farther at most.
#import common/vector
#import common/thread
#import cells/grid
#import surface/surface

var<storage, read> shell_position: array<vec4f>;

// Of a thread that has no node.
const NOBODY: i32 = QUARANTINE + 1;

// The node of a thread: MARK_SIDE along each direction around a particle.
fn next_voxel(thread: Thread) -> Coordinate {
    let item = item_index(thread);
    let particle = item / (MARK_SIDE * MARK_SIDE * MARK_SIDE);
    if particle >= surface.shell {
        return Coordinate(NOBODY);
    }
    let x = (shell_position[particle].xyz - surface.lower.xyz) / surface.width;
    let farthest = surface.farthest / surface.width;
    let number = (vec3u(item) / vec3u(1u, MARK_SIDE, MARK_SIDE * MARK_SIDE)) % vec3u(MARK_SIDE);
    let node = ceil(x - (farthest + 1.0)) + vec3f(number);
    let apart = max(abs(node - x) - 1.0, vec3f(0.0));
    let is_near = dot(apart, apart) <= farthest * farthest;
    let is_in_grid = all(node >= vec3f(0.0)) && all(node < vec3f(grid.high.xyz));
    return select(Coordinate(NOBODY), Coordinate(node), is_near && is_in_grid);
}

// Whether there is a node.
fn is_followed(v: Coordinate) -> bool {
    return v.x < QUARANTINE;
}
