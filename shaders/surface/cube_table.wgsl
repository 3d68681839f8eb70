// Triangles of a cell by which of its corners are inside (surface::cubes): CUBE_ROW numbers a row, first how many triangles,
// then the edges of each, four bits an edge. Edge 4 a + b runs along axis a; b says which of the four, from the lower bit on
// along the axes a + 1 and a + 2.
var<storage, read> cube_table: array<u32>;

fn triangles_of(corners: u32) -> u32 {
    return cube_table[CUBE_ROW * corners];
}

fn triangle_edges(corners: u32, triangle: u32) -> vec3u {
    return (vec3u(cube_table[CUBE_ROW * corners + 1u + triangle]) >> vec3u(0u, 4u, 8u)) & vec3u(15u);
}
