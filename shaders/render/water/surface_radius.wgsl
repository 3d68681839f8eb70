// The radius of a particle's sphere in the water's surface.

#import render/water/sphere

// Smaller where the particle has few neighbors, and that of a drop where it is one.
fn surface_radius(i: u32) -> f32 {
    return mix(water.drop_radius, water.radius, crowd(i));
}
