// Which particles pictures show: all but boundary particles.
#import render/state

#import physics/fluid/walls

fn is_drawn(i: u32) -> bool {
    return !is_wall(i);
}
