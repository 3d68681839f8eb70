// Colors of the mesh in pictures, sRGB bytes: of the mean of the particles' values around each vertex.
#import common/thread
#import physics/fluid/boundary_particles
#import render/picture
#import render/state
#import <column>
#import <candidates>
#import surface/surface

var<storage, read> color_map: array<u32>;
var<storage, read> mesh_position: array<vec4f>;
var<storage, read_write> mesh_color: array<u32>;

@compute @workgroup_size(GROUP_SIZE)
fn color_mesh(thread: Thread) {
    let vertex = item_index(thread);
    if vertex >= surface.vertices {
        return;
    }
    let x = mesh_position[vertex].xyz;
    let home = voxel_of(x);
    let square = surface.reach * surface.reach;
    var sum = vec2f(0.0);
    for (var k = 0u; k < RANGES; k++) {
        let range = candidate_range(home, k);
        for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
            let j = candidate(slot);
            let y = unpack(position[j]) - x;
            let share = 1.0 - dot(y, y) / square;
            if share > 0.0 && !is_boundary(j) {
                sum += share * share * share * vec2f(column(j), 1.0);
            }
        }
    }
    let share = saturate((sum.x / max(sum.y, 1e-20) - picture.color_low) * picture.color_scale);
    mesh_color[vertex] = color_map[u32(share * 255.0 + 0.5)];
}
