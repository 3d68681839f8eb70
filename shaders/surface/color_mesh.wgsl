// Colors of the mesh in pictures, sRGB bytes: of the mean of the particles' values around each vertex.
#import render/picture
#import render/state
#import <column>
#import surface/blend

var<storage, read> color_map: array<u32>;
var<storage, read> mesh_position: array<vec4f>;
var<storage, read_write> mesh_color: array<u32>;

fn blended(particle: u32, part: u32) -> f32 {
    return column(particle);
}

@compute @workgroup_size(GROUP_SIZE)
fn color_mesh(thread: Thread) {
    let vertex = item_index(thread);
    if vertex >= surface.vertices {
        return;
    }
    let value = blend(mesh_position[vertex].xyz)[0];
    let share = saturate((value - picture.color_low) * picture.color_scale);
    mesh_color[vertex] = color_map[u32(share * 255.0 + 0.5)];
}
