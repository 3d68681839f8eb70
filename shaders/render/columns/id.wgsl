#import render/state

fn column(i: u32) -> f32 {
    return f32(id[i]);
}
