// The cells between eight nodes (Lorensen and Cline 1987). A cell and the three edges along u, s and w belong to the node at
// its lowest corner. Corner c stands (c & 1, c >> 1 & 1, c >> 2) above it.
#import common/thread
#import <addressing>
#import surface/surface

var<storage, read> surface_node: array<vec2u>;
var<storage, read> surface_value: array<f32>;

const NO_ADDRESS: u32 = 0xffffffffu;

// Address of a node near the surface.
fn find(node: Coordinate) -> u32 {
    let at = span(node, 0u);
    if at.x >= at.y {
        return NO_ADDRESS;
    }
    return select(NO_ADDRESS, at.x, is_marked(surface_node[at.x]));
}

fn value_at(node: Coordinate) -> f32 {
    let at = find(node);
    if at == NO_ADDRESS {
        return ABSENT;
    }
    return surface_value[at];
}

fn corner(number: u32) -> Coordinate {
    return vec3i(vec3u(number & 1u, (number >> 1u) & 1u, number >> 2u));
}

fn unit(axis: u32) -> Coordinate {
    return vec3i(vec3u(axis) == vec3u(0u, 1u, 2u));
}

// What a cell keeps: bits 0 to 7 say which corners are inside, bits 8 to 10 which of its node's edges the surface crosses.
fn corners_inside(cell: u32) -> u32 {
    return cell & 0xffu;
}

fn crossed_edges(cell: u32) -> u32 {
    return cell >> 8u;
}
