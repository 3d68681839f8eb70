// Boundary particles in reach: those that had fluid within the search radius and the skin when particles were searched last. No
// fluid comes near the others before the next search, so they have no lists, and passes over numbers leave them out.
#import common/parameters

struct Reached {
    count: u32,
    particles: array<u32>, // in the order of their places
}

var<storage, read> reached: Reached;

// The particle of a number, which is also that of its list: all particles of the fluid, then the boundary particles in reach.
// Without one, the number of all particles.
fn numbered_particle(number: u32) -> u32 {
    if number < parameters.free_count {
        return number;
    }
    let place = number - parameters.free_count;
    if place >= reached.count {
        return parameters.particle_count;
    }
    return reached.particles[place];
}
