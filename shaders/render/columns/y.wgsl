// Metres, in local coordinates; the host moves the range by the scene's origin, in f64.

#import render/state

fn column(i: u32) -> f32 {
    return position[i].y;
}
