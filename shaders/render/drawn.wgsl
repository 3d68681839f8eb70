// Which particles pictures show: all but boundary particles.
#import render/state

#import physics/fluid/boundary_particles

fn is_drawn(i: u32) -> bool {
    return !is_boundary(i);
}
