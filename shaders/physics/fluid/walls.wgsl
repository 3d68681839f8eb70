// Which particles are boundary particles. The file that imports this one has their `id`.
#if boundary_particles
#import physics/fluid/coefficients


fn is_wall(i: u32) -> bool {
    return id[i] >= fluid.first_wall;
}
#else
fn is_wall(i: u32) -> bool {
    return false;
}
#end
