//! A head-on collision with a linear spring and dashpot, which is half a period of a damped oscillator.
//!
//! The contact ends at zero overlap, so the dashpot may pull at its end; ended where the whole force has come to zero,
//! it would give back more than e ([`Collision::restitution_without_pull`]).

use std::f64::consts::PI;

/// Two bodies that touch at time zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Collision {
    /// e: speed after over speed before, above zero.
    pub restitution: f64,
    /// ω0 = √(k/m*), rad/s, of the spring k and the reduced mass m*.
    pub frequency: f64,
    /// Speed of approach, m/s.
    pub speed: f64,
}

impl Collision {
    /// β = −ln e / √(π² + ln² e).
    pub fn damping_ratio(&self) -> f64 {
        let ln = self.restitution.ln();
        -ln / (PI * PI + ln * ln).sqrt()
    }

    /// √(1 − β²).
    fn slowing(&self) -> f64 {
        (1.0 - self.damping_ratio().powi(2)).sqrt()
    }

    /// t_c = π / (ω0 √(1 − β²)), s.
    pub fn duration(&self) -> f64 {
        PI / (self.frequency * self.slowing())
    }

    /// When the overlap is largest, s.
    pub fn time_of_largest_overlap(&self) -> f64 {
        let s = self.slowing();
        s.atan2(self.damping_ratio()) / (self.frequency * s)
    }

    /// m.
    pub fn largest_overlap(&self) -> f64 {
        let decay = -self.damping_ratio() * self.frequency * self.time_of_largest_overlap();
        self.speed / self.frequency * decay.exp()
    }

    /// What e becomes where a contact ends as soon as spring and dashpot cancel.
    pub fn restitution_without_pull(&self) -> f64 {
        let (beta, s) = (self.damping_ratio(), self.slowing());
        let phase = (2.0 * beta * s).atan2(2.0 * beta * beta - 1.0);
        (-beta * phase / s).exp()
    }
}
