// What impulses of pressure do to a velocity.
#import physics/fluid/coefficients
#import physics/dfsph/pairs

// Change of velocity by the impulses, m/s; so often walls count, see compression_rate().
fn push_on(i: u32, wall_share: f32) -> Vector {
    let own_impulse = impulse[i];
    var push = Vector(0.0);
    let range = pairs_of(i);
    for (var slot = range.x; slot < range.y; slot += LIST_LANES) {
        let pair = pair_list[slot];
        push += (own_impulse + impulse[pair_particle(pair)]) * pair_gradient(pair);
    }
    return finished(i, push, own_impulse, wall_share);
}

// The same, of a sum over the pairs alone.
fn finished(i: u32, pairs: Vector, own_impulse: f32, wall_share: f32) -> Vector {
    var push = pairs * dfsph.steepest * gradient_unit();
#if boundary_particles
    push += wall_share * own_impulse * unpack(walls[i].pull);
#end
    return push / fluid.density;
}
