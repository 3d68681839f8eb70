// Particles to their places in sorted order, and where each of them was.
#import fields/place

// By slot: the place that the last step left the particle in.
var<storage, read_write> origin: array<u32>;

fn take_place(i: u32, slot: u32) {
    place(i, slot);
    origin[slot] = i;
}
