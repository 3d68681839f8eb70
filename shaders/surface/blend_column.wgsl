// A column of the particles at the vertices of the mesh.
#import physics/present
#import surface/blend

var<storage, read> column_value: array<f32>; // COLUMN_WIDTH numbers per particle, by id
var<storage, read> mesh_position: array<vec4f>;
var<storage, read_write> vertex_value: array<f32>;

fn blended(particle: u32, part: u32) -> f32 {
    return column_value[COLUMN_WIDTH * id[particle] + part];
}

@compute @workgroup_size(GROUP_SIZE)
fn blend_column(thread: Thread) {
    let vertex = item_index(thread);
    if vertex >= surface.vertices {
        return;
    }
    let values = blend(mesh_position[vertex].xyz);
    for (var part = 0u; part < COLUMN_WIDTH; part++) {
        vertex_value[COLUMN_WIDTH * vertex + part] = values[part];
    }
}
