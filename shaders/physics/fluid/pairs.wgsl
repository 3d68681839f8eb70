// Pairs of particles.
#import common/vector
#import common/reach
#import common/parameters
#import physics/present
#import physics/fluid/coefficients
#import physics/fluid/boundary_particles
#import <kernel>
#import <candidates>
#import cells/images

// From x to particle j, m; to its nearest image where space repeats.
fn toward(x: Vector, j: u32) -> Vector {
    return nearest_image(unpack(position[j]) - x);
}
