// Müller 2003: poly6 for density, the gradient of spiky for pressure, and a Laplacian for viscosity.
#import physics/fluid/coefficients

fn kernel(r: f32) -> f32 {
    let q = r * fluid.inverse_smoothing;
    let u = max(1.0 - q * q, 0.0);
    return fluid.kernel_scale * u * u * u;
}

// (dW/dr) / r of spiky
fn kernel_slope(r: f32) -> f32 {
    let q = r * fluid.inverse_smoothing;
    let u = max(1.0 - q, 0.0);
    return fluid.slope_scale * -3.0 * u * u / max(q, 1e-3);
}

fn kernel_laplacian(r: f32) -> f32 {
    return fluid.laplacian_scale * max(1.0 - r * fluid.inverse_smoothing, 0.0);
}
