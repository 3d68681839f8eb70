//! A weakly compressible fluid at rest below a free surface: dp/dy = −ρ g with the Tait equation.

/// Fluid of depth `depth` under gravity; its density is `density` at the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StillWater {
    /// H, m.
    pub depth: f64,
    /// g, m/s².
    pub gravity: f64,
    /// ρ0, kg/m³.
    pub density: f64,
    /// c, m/s.
    pub sound_speed: f64,
    /// γ of the Tait equation p = (ρ0 c²/γ) ((ρ/ρ0)^γ − 1); 1 makes it linear.
    pub gamma: f64,
}

impl StillWater {
    /// ρ/ρ0 at height `y` (m) above the floor: (ρ/ρ0)^(γ−1) = 1 + (γ−1) g (H−y) / c², and its limit for γ = 1.
    fn density_ratio(&self, y: f64) -> f64 {
        let head = self.gravity * (self.depth - y) / (self.sound_speed * self.sound_speed);
        let power = self.gamma - 1.0;
        if power == 0.0 {
            head.exp()
        } else {
            (1.0 + power * head).powf(1.0 / power)
        }
    }

    /// kg/m³.
    pub fn density_at(&self, y: f64) -> f64 {
        self.density * self.density_ratio(y)
    }

    /// Pa.
    pub fn pressure(&self, y: f64) -> f64 {
        let stiffness = self.density * self.sound_speed * self.sound_speed / self.gamma;
        stiffness * (self.density_ratio(y).powf(self.gamma) - 1.0)
    }
}
