// m/s

#import render/state

fn column(i: u32) -> f32 {
    return to_3d(unpack(velocity[i])).z;
}
