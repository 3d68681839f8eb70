// Beyond a wall, pressure goes on to grow with depth (Adami 2012, Eq. 27), where there is any.
#import common/parameters
#import physics/fluid/coefficients

// Share of the gravity beyond a wall that acts at a pressure.
fn lifted(pressure: f32) -> f32 {
    let weight = fluid.density * length(first(parameters.gravity)) * fluid.spacing;
    return clamp(2.0 * pressure / max(weight, 1e-30), 0.0, 1.0);
}
