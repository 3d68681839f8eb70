// Values that come with the particles instead of being measured, by id.
#import render/state

var<storage, read> given_column: array<f32>;

fn column(i: u32) -> f32 {
    // Boundary particles have none.
    return given_column[min(id[i], arrayLength(&given_column) - 1u)];
}
