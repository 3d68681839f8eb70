// Grains of several sizes, as shares of the largest, for which coefficients are.
#import fields/radius
#import host/largest

// Radius over that of the largest.
fn size_of(i: u32) -> f32 {
    return radius[i] / LARGEST_RADIUS;
}

// Mass over that of the largest.
fn mass_share(size: f32) -> f32 {
#if two_dimensional
    return size * size;
#else
    return size * size * size;
#end
}

// Moment of inertia over that of the largest.
fn inertia_share(size: f32) -> f32 {
    return mass_share(size) * size * size;
}

// Of two that meet: effective mass or radius, or moment of inertia about the contact, over that of two of the largest.
fn effective_share(a: f32, b: f32) -> f32 {
    return 2.0 * a * b / (a + b);
}

// How near two centers have to be where those of two of the largest have to be nearer than `largest`, m.
fn pair_reach(i: u32, j: u32, largest: f32) -> f32 {
    return largest - 2.0 * LARGEST_RADIUS + radius[i] + radius[j];
}
