// What impulses of pressure do to a velocity.
#import physics/fluid/coefficients
#import physics/dfsph/pairs

var<storage, read> impulse: array<f32>; // Pa·s

// Change of velocity by the impulses, m/s. Beyond a wall stands the mirror image of the fluid before it, with the same pressure.
fn push_on(i: u32) -> Vector {
    let own_impulse = impulse[i];
    var push = Vector(0.0);
    let range = pairs_of(i);
    for (var slot = range.x; slot < range.y; slot += LIST_LANES) {
        let pair = pair_list[slot];
        push += (own_impulse + impulse[pair_particle(pair)]) * pair_gradient(pair);
    }
    push *= dfsph.steepest * gradient_unit();
#if boundary_particles
    push += 2.0 * own_impulse * unpack(wall_pull[i]);
#end
    return push / fluid.density;
}
