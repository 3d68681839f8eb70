// The second pass of an iteration: what impulses do to a velocity. The file that imports this one has `acting_impulse`.
#import physics/fluid/coefficients
#import physics/dfsph/pairs


// Change of velocity by the impulses, m/s. Walls have none of their own (Akinci 2012): so what impulses do is the exact
// counterpart of the rate that they act against (solve.wgsl), and no energy comes from nowhere. The pressure of the row along
// a wall then carries for both.
fn push_on(i: u32) -> Vector {
    let impulse = acting_impulse[i];
    var push = Vector(0.0);
    let range = pairs_of(i);
    for (var slot = range.x; slot < range.y; slot += LIST_LANES) {
        let pair = pair_list[slot];
        push += (impulse + acting_impulse[pair_particle(pair)]) * pair_gradient(pair);
    }
    push *= dfsph.steepest * gradient_unit();
#if boundary_particles
    push += impulse * unpack(wall_pull[i]);
#end
    return push / fluid.density;
}
