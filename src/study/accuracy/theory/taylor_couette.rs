//! Steady flow between two turning cylinders (circular Couette flow): Landau and Lifshitz, Fluid Mechanics, § 18.

/// Cylinders about one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TaylorCouette {
    /// Radii of the inner and the outer cylinder, m.
    pub radii: [f64; 2],
    /// Their angular speeds, rad/s.
    pub turns: [f64; 2],
    /// kg/m³.
    pub density: f64,
}

impl TaylorCouette {
    /// A (1/s) and B (m²/s) in u = A r + B / r.
    fn coefficients(&self) -> (f64, f64) {
        let [inner, outer] = self.radii.map(|r| r * r);
        let [slow, fast] = self.turns;
        let a = (fast * outer - slow * inner) / (outer - inner);
        let b = (slow - fast) * inner * outer / (outer - inner);
        (a, b)
    }

    /// Speed around the axis at radius `r` (m), m/s.
    pub fn speed(&self, r: f64) -> f64 {
        let (a, b) = self.coefficients();
        a * r + b / r
    }

    /// rad/s.
    pub fn angular_speed(&self, r: f64) -> f64 {
        self.speed(r) / r
    }

    /// Pressure above that at the inner cylinder, Pa: dp/dr = ρ u²/r.
    pub fn pressure(&self, r: f64) -> f64 {
        let (a, b) = self.coefficients();
        let primitive = |r: f64| a * a * r * r / 2.0 + 2.0 * a * b * r.ln() - b * b / (2.0 * r * r);
        self.density * (primitive(r) - primitive(self.radii[0]))
    }
}
