// A column of the particles at the vertices of the mesh: the mean by the weights of the implicit function.
#import common/thread
#import physics/present
#import physics/fluid/boundary_particles
#import <candidates>
#import surface/surface

var<storage, read> column_value: array<f32>; // COLUMN_WIDTH numbers per particle, by id
var<storage, read> mesh_position: array<vec4f>;
var<storage, read_write> vertex_value: array<f32>;

@compute @workgroup_size(GROUP_SIZE)
fn blend_column(thread: Thread) {
    let vertex = item_index(thread);
    if vertex >= surface.vertices {
        return;
    }
    let x = mesh_position[vertex].xyz;
    let home = voxel_of(x);
    let square = surface.reach * surface.reach;
    var sum = array<f32, COLUMN_WIDTH>();
    var weights = 0.0;
    for (var k = 0u; k < RANGES; k++) {
        let range = candidate_range(home, k);
        for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
            let j = candidate(slot);
            let y = unpack(position[j]) - x;
            let share = select(max(1.0 - dot(y, y) / square, 0.0), 0.0, is_boundary(j));
            let weight = share * share * share;
            if weight <= 0.0 {
                continue;
            }
            weights += weight;
            for (var part = 0u; part < COLUMN_WIDTH; part++) {
                sum[part] += weight * column_value[COLUMN_WIDTH * id[j] + part];
            }
        }
    }
    for (var part = 0u; part < COLUMN_WIDTH; part++) {
        vertex_value[COLUMN_WIDTH * vertex + part] = sum[part] / max(weights, 1e-20);
    }
}
