// Quintic spline (Schoenberg 1946; Morris 1997).
#import physics/fluid/coefficients

fn kernel(r: f32) -> f32 {
    let q = r * fluid.inverse_smoothing;
    let t = max(vec3f(3.0, 2.0, 1.0) - q, vec3f(0.0));
    let t2 = t * t;
    return fluid.kernel_scale * dot(t2 * t2 * t, vec3f(1.0, -6.0, 15.0));
}

// (dW/dr) / r
fn kernel_slope(r: f32) -> f32 {
    let q = r * fluid.inverse_smoothing;
    let t = max(vec3f(3.0, 2.0, 1.0) - q, vec3f(0.0));
    let t2 = t * t;
    return fluid.slope_scale * dot(t2 * t2, vec3f(-5.0, 30.0, -75.0)) / max(q, 1e-3);
}
