//! A dam that breaks over a dry bed, in shallow water: Ritter 1892.
//!
//! ξ = x / (t √(g H)), with the dam at x = 0 and water of depth H on the left.

/// Depth over H.
pub fn depth(xi: f64) -> f64 {
    let fan = xi.clamp(-1.0, 2.0);
    (2.0 - fan).powi(2) / 9.0
}

/// Speed over √(g H); zero where there is no motion and where there is no water.
pub fn speed(xi: f64) -> f64 {
    if (-1.0..=2.0).contains(&xi) {
        2.0 / 3.0 * (1.0 + xi)
    } else {
        0.0
    }
}
