// Viscous forces by boundary particles. The mirror image of the fluid before a wall stands beyond it and moves the other way
// (Morris et al. 1997), so the wall's own face is where fluid sticks.
#import physics/fluid/matrix
#import physics/dfsph/shear
#import <kernel>

// What a boundary particle at a distance of s multiplies the difference of velocities by, 1/m².
fn wall_shear_by(s: Vector) -> Matrix {
    let square = dot(s, s);
    let near = -2.0 * dfsph.slope_volume * kernel_slope(sqrt(square));
    let weight = MIRRORED * shear_weight(near, square / (fluid.spacing * fluid.spacing));
    return outer(s, s) * (weight / max(square, 1e-30));
}
