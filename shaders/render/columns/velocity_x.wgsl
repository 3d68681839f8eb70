// m/s

#import render/state

fn column(i: u32) -> f32 {
    return velocity[i].x;
}
