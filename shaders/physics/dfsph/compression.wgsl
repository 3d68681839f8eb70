// How fast the fluid is pressed together. The file that imports this one has `velocity_of(j)`.
#import physics/time_step
#import physics/dfsph/pairs

// −∇·v at particle i, 1/s. Walls count once as what density sees of them, and twice (`MIRRORED`) where the mirror image of
// the fluid before them stands beyond, which moves the other way.
fn compression_rate(i: u32, wall_share: f32) -> f32 {
    let v = velocity_of(i);
    var rates = Vector(0.0);
    let range = pairs_of(i);
    for (var slot = range.x; slot < range.y; slot += LIST_LANES) {
        let pair = pair_list[slot];
        rates += (velocity_of(pair_particle(pair)) - v) * pair_gradient(pair);
    }
    var rate = dfsph.steepest * dot(rates, gradient_unit());
#if boundary_particles
    rate += wall_share * (number_of(walls[i].pull) - dot(v, unpack(walls[i].pull)));
#end
    return rate;
}
