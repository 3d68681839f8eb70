// Which particles pictures show: all but boundary particles.
#import render/state

#if boundary_particles
#import physics/fluid/coefficients

fn is_drawn(i: u32) -> bool {
    return id[i] < fluid.first_wall;
}
#else
fn is_drawn(i: u32) -> bool {
    return true;
}
#end
