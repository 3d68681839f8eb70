//! The decaying vortices of Taylor and Green (1937) in a periodic square: an exact solution of the incompressible
//! Navier–Stokes equations.

use std::f64::consts::PI;

/// Vortices in a square of side `length`, periodic both ways.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TaylorGreen {
    /// U L / ν.
    pub reynolds: f64,
    /// Side L of the square, m.
    pub length: f64,
    /// Largest speed U at the start, m/s.
    pub speed: f64,
    /// kg/m³.
    pub density: f64,
}

impl TaylorGreen {
    /// In the unit square with speed and density one.
    pub fn unit(reynolds: f64) -> Self {
        Self {
            reynolds,
            length: 1.0,
            speed: 1.0,
            density: 1.0,
        }
    }

    /// m²/s.
    pub fn viscosity(&self) -> f64 {
        self.speed * self.length / self.reynolds
    }

    /// b in u ∝ exp(b t), 1/s: b = −8 π² ν / L².
    pub fn rate(&self) -> f64 {
        -8.0 * PI * PI * self.viscosity() / (self.length * self.length)
    }

    /// Largest speed at time `t` (s), m/s.
    pub fn largest_speed(&self, t: f64) -> f64 {
        self.speed * (self.rate() * t).exp()
    }

    /// Mean of the kinetic energy over the square, J/m³.
    pub fn energy(&self, t: f64) -> f64 {
        0.25 * self.density * self.largest_speed(t).powi(2)
    }

    /// u = −U eᵇᵗ cos 2πx/L sin 2πy/L, v = U eᵇᵗ sin 2πx/L cos 2πy/L, m/s.
    pub fn velocity(&self, [x, y]: [f64; 2], t: f64) -> [f64; 2] {
        let largest = self.largest_speed(t);
        let [x, y] = [x, y].map(|s| 2.0 * PI * s / self.length);
        [-largest * x.cos() * y.sin(), largest * x.sin() * y.cos()]
    }

    /// p = −(ρ U²/4) e²ᵇᵗ (cos 4πx/L + cos 4πy/L), Pa, zero on average.
    pub fn pressure(&self, [x, y]: [f64; 2], t: f64) -> f64 {
        let [x, y] = [x, y].map(|s| (4.0 * PI * s / self.length).cos());
        -0.25 * self.density * self.largest_speed(t).powi(2) * (x + y)
    }
}
