// One of the pictures that a frame is the mean of.

struct Subframe {
    after_s: f32, // from the frame to this picture; negative before the frame
    share: f32, // one over the number of pictures
    count: u32, // particles
    reserved: u32,
}

var<storage, read> subframe: Subframe;
