// Which particles are boundary particles. The file that imports this one has their `id`.
#if boundary_particles
#import common/parameters

fn is_boundary(i: u32) -> bool {
#if separated
    return i >= parameters.free_count;
#else
    return id[i] >= parameters.first_boundary;
#end
}
#else
fn is_boundary(i: u32) -> bool {
    return false;
}
#end
