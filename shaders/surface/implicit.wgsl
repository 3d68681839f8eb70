// The implicit function of the particles, negative inside. A side of the domain mirrors them, and what lies beyond is cut off.
#import common/vector
#import physics/present
#import <candidates>
#import surface/mirrors
#import <implicit>

fn field_at(x: vec3f) -> Field {
    var field = no_field();
    for (var number = 0u; number < 8u; number++) {
        let image = image_of(x, number);
        if !image.is_seen {
            continue;
        }
        let home = voxel_of(image.at);
        for (var k = 0u; k < RANGES; k++) {
            let range = candidate_range(home, k);
            for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
                add_particle(&field, candidate(slot), image);
            }
        }
    }
    return field;
}
