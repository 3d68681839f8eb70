// Gradient of a color that is one in a fluid and in walls, zero outside (Morris 2000): it points from the surface into
// the fluid. Beside walls it turns to the contact angle (Brackbill 1992; blended as in Breinlinger 2013).
#import common/thread
#import physics/fluid/pairs
#import physics/fluid/material
#import physics/fluid/state
#import physics/fluid/pair_state
#if planes
#import physics/fluid/planes
#end
var<storage, read_write> surface_normal: array<Packed>;

// Slopes below this one over the support are noise of uneven particles.
const FAINT: f32 = 0.5;
// That of walls beside a particle that touches them.
const TOUCHING: f32 = 0.3;

@compute @workgroup_size(GROUP_SIZE)
fn find_surface(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    if is_boundary(i) {
        surface_normal[i] = pack(Vector(0.0));
        return;
    }
    let mine = pair_state[i].place;
    let x = unpack(mine);
    var normal = Vector(0.0);
    var offset = Vector(0.0); // of the mass around: where the fluid lies, less noisy than the slope
    var wall_normal = Vector(0.0);
    let home = around(i, x);
    for (var k = 0u; k < RANGES; k++) {
        let range = candidate_range(home, k);
        for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
            let j = candidate(slot);
            let theirs = pair_state[j].place;
            let s = nearest_image(unpack(theirs) - x);
            if within(s, fluid.support) && j != i {
                let r = length(s);
                let slope = -volume_at(number_of(theirs)) * kernel_slope(r) * s;
                let near = (1.0 - r / fluid.support) * s;
                wall_normal += select(Vector(0.0), slope, is_boundary(j));
#if several_materials
                let own = is_boundary(j) || material[j] == material[i];
                normal += select(Vector(0.0), slope, own);
                offset += select(Vector(0.0), near, own);
#else
                normal += slope;
                offset += near;
#end
            }
        }
    }
#if planes
    let cells = cells_beyond(x);
    for (var number = 0u; number < cells; number++) {
        let cell = beyond(x, number);
        let r = length(cell.offset);
        let slope = -cell.share * volume_at(number_of(mine)) * kernel_slope(r) * cell.offset;
        normal += slope;
        offset += (cell.share * max(1.0 - r / fluid.support, 0.0)) * cell.offset;
        wall_normal += slope;
    }
#end
    let steepness = length(normal);
    let into_wall = wall_normal / max(length(wall_normal), 1e-30);
    let along = offset - dot(offset, into_wall) * into_wall;
    let sine = sqrt(1.0 - fluid.wetting * fluid.wetting);
    let met = fluid.wetting * into_wall + sine * along / max(length(along), 1e-30);
    let touch = min(length(wall_normal) * fluid.support / TOUCHING, 1.0);
    let turned = mix(offset / max(length(offset), 1e-30), met, touch);
    let clear = select(0.0, steepness, steepness * fluid.support > FAINT);
    surface_normal[i] = pack(clear * turned / max(length(turned), 1e-30));
}
