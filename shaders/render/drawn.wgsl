// Which particles pictures show, all but boundary particles, and how large.
#import render/state
#import render/picture
#import physics/fluid/boundary_particles
#if sizes
#import common/sizes
#end

fn is_drawn(i: u32) -> bool {
    return !is_boundary(i);
}

fn drawn_radius(i: u32) -> f32 {
#if sizes
    return picture.radius * size_of(i);
#else
    return picture.radius;
#end
}
