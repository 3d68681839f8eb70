// The voxels that have memory as a square picture: one texel a voxel in the order in which they lie there, row by row.
#import <storage>

// Smallest side whose square holds `total` texels.
fn side_of(total: u32) -> u32 {
    var side = u32(sqrt(f32(total)));
    if side * side < total {
        side += 1u;
    }
    if side > 0u && (side - 1u) * (side - 1u) >= total {
        side -= 1u;
    }
    return max(side, 1u);
}

// Particles at a pixel of a square of `room` pixels: whole texels where they fit, else the fullest of a block of
// voxels.
fn fullest_at(pixel: vec2u, room: u32) -> u32 {
    let total = voxel_total();
    let side = side_of(total);
    let scale = max(room / side, 1u);
    let block = (side + room - 1u) / room;
    let texel = pixel / scale * block;
    var fullest = 0u;
    var found = false;
    for (var y = texel.y; y < min(texel.y + block, side); y += 1u) {
        for (var x = texel.x; x < min(texel.x + block, side); x += 1u) {
            let voxel = y * side + x;
            if voxel < total {
                found = true;
                fullest = max(fullest, occupancy(voxel));
            }
        }
    }
    return select(NO_VOXEL, fullest, found);
}
