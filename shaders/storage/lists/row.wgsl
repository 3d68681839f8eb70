// A row per particle: how many neighbors it has, then they, with room for grid.list_capacity. Where a solver wants boundary
// particles apart, the row begins with two numbers: of the others, which come next, and of boundary particles, which stand at
// the row's end. These are LIST_HEAD numbers.
//
// Where boundary particles out of reach have no lists, the rows of the others follow those of the fluid
// (storage/lists/reached.wgsl).
//
// Rows of LIST_LANES particles are interleaved, so that threads side by side read numbers side by side.
#import cells/grid

// Where the row of particle i begins; from one of its numbers to the next are LIST_LANES.
fn list_row(i: u32) -> u32 {
    return interleaved_row(i, grid.list_capacity + LIST_HEAD);
}

// The same for rows of so many items.
fn interleaved_row(i: u32, items: u32) -> u32 {
    return (i / LIST_LANES) * LIST_LANES * items + i % LIST_LANES;
}
