// What a grain's color is found by, where a look has colors of its own: a share by chance, the same in every frame.

#import render/state
#import render/picture
#import render/random_share

fn column(i: u32) -> f32 {
    return picture.color_low + random_share(id[i]) / picture.color_scale;
}
