// Cubic spline (Monaghan and Lattanzio 1985).
#import physics/fluid/coefficients

fn kernel(r: f32) -> f32 {
    let q = r * fluid.inverse_smoothing;
    let far = max(2.0 - q, 0.0);
    return fluid.kernel_scale * select(0.25 * far * far * far, 1.0 + q * q * (0.75 * q - 1.5), q < 1.0);
}

// (dW/dr) / r
fn kernel_slope(r: f32) -> f32 {
    let q = r * fluid.inverse_smoothing;
    let far = max(2.0 - q, 0.0);
    return fluid.slope_scale * select(-0.75 * far * far / max(q, 1.0), 2.25 * q - 3.0, q < 1.0);
}
