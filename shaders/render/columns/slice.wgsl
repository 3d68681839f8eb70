// Voxel coordinate along the slicing axis.

#import render/state
#import cells/grid

fn column(i: u32) -> f32 {
    return f32(clamp(voxel_of(unpack(position[i])).y, 0, grid.size.y - 1));
}
