// Viscous stress of each particle of the fluid (Rojas 2013, Eq. 4): μ (∇v + ∇vᵀ − ⅔ ∇·v).
#import common/thread
#import physics/fluid/pairs
#import physics/fluid/material
#import physics/fluid/state
#import physics/fluid/pair_state
#import physics/fluid/matrix
#import physics/fluid/viscous
#if planes
#import physics/fluid/planes
#end
#if gradient_correction
var<storage, read> correction: array<Matrix>;
#end
var<storage, read_write> stress: array<Matrix>;

@compute @workgroup_size(GROUP_SIZE)
fn find_stress(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count || is_boundary(i) {
        return;
    }
    let mine = pair_state_at(i);
    let x = unpack(mine.place);
    let v = unpack(mine.motion);
    var slopes = Matrix();
    let home = around(i, x);
    for (var k = 0u; k < RANGES; k++) {
        let range = candidate_range(home, k);
        for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
            let j = candidate(slot);
            let theirs = pair_state_at(j);
            let s = nearest_image(unpack(theirs.place) - x);
            if within(s, fluid.support) && j != i {
                let weight = volume_at(number_of(theirs.place)) * kernel_slope(length(s));
                let seen = viscous(j, unpack(theirs.motion));
#if slips
                slopes -= weight * outer(select(seen - v, Vector(0.0), is_boundary(j)), s);
#else
                slopes -= weight * outer(seen - v, s);
#end
            }
        }
    }
#if planes
#if !slips
    let cells = cells_beyond(x);
    for (var number = 0u; number < cells; number++) {
        let cell = beyond(x, number);
        let weight = cell.share * volume_at(number_of(mine.place)) * kernel_slope(length(cell.offset));
        slopes -= weight * outer(cell.stretch * (cell.velocity - v), cell.offset);
    }
#end
#end
#if gradient_correction
    slopes = slopes * correction[i];
#end
    let sheared = slopes + transpose(slopes) - (2.0 / 3.0 * trace(slopes)) * unit();
    stress[i] = material_of(i).viscosity * sheared;
}
