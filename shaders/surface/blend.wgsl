// Means of the particles' values around a point, by the weights of Zhu and Bridson 2005. The file that imports this one says
// what is blended: `blended(particle, part)`, COLUMN_WIDTH parts.
#import common/thread
#import common/vector
#import physics/fluid/boundary_particles
#import <candidates>
#import surface/surface

fn blend(x: vec3f) -> array<f32, COLUMN_WIDTH> {
    let home = voxel_of(x);
    let square = surface.reach * surface.reach;
    var sum = array<f32, COLUMN_WIDTH>();
    var weights = 0.0;
    for (var k = 0u; k < RANGES; k++) {
        let range = candidate_range(home, k);
        for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
            let j = candidate(slot);
            let y = unpack(position[j]) - x;
            let share = 1.0 - dot(y, y) / square;
            if share <= 0.0 || is_boundary(j) {
                continue;
            }
            let weight = share * share * share;
            weights += weight;
            for (var part = 0u; part < COLUMN_WIDTH; part++) {
                sum[part] += weight * blended(j, part);
            }
        }
    }
    for (var part = 0u; part < COLUMN_WIDTH; part++) {
        sum[part] /= max(weights, 1e-20);
    }
    return sum;
}
