// Weights of viscous forces, which act along the line of a pair (Monaghan and Gingold 1983): angular momentum stays, and a free
// surface does not hold what turns. By a kernel two spacings wide they would resist along a lattice's axes much less than
// across (physics::kernels::shear); growing with the distance they resist alike.
#import physics/fluid/coefficients
#import physics/dfsph/loop

// Of a pair with this weight in the pressure equation, 1/m², and with this square of its distance in spacings: factor of what
// the velocities differ along its line.
fn shear_weight(weight: f32, square: f32) -> f32 {
    return weight * (dfsph.shear + dfsph.far_shear * square * square);
}

// The square of the distance in spacings, by that weight and the gradient, 1/m, at most that of the support.
fn pair_square(weight: f32, gradient_square: f32) -> f32 {
    let reach = fluid.support / fluid.spacing;
    let length = 2.0 / max(weight * fluid.spacing, 1e-30);
    return min(length * length * gradient_square, reach * reach);
}
