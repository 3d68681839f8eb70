// Wendland's C4 (1995) in 2D and 3D.
#import physics/fluid/coefficients

fn kernel(r: f32) -> f32 {
    let q = r * fluid.inverse_smoothing;
    let u = max(1.0 - 0.5 * q, 0.0);
    return fluid.kernel_scale * (u * u) * (u * u) * (u * u) * ((35.0 / 12.0 * q + 3.0) * q + 1.0);
}

// (dW/dr) / r
fn kernel_slope(r: f32) -> f32 {
    let q = r * fluid.inverse_smoothing;
    let u = max(1.0 - 0.5 * q, 0.0);
    return fluid.slope_scale * (-14.0 / 3.0) * (u * u) * (u * u) * u * (1.0 + 2.5 * q);
}
