//! From what the user gives about contacts to coefficients, and how long a contact lasts.
//!
//! A head-on contact is a damped oscillator of mass m_eff (m/2 for two grains, m at a wall), spring k and dashpot η:
//! ω₀ = √(k / m_eff), damping ratio β = η / (2 √(k m_eff)). It ends after half a period, and
//! restitution e = exp(−π β / √(1 − β²)).

use std::f64::consts::PI;

use super::friction;
use super::model::{Change, Dashpot, Grains};
use super::{Contact, Dimensions, frame::Report};

/// The contact law as the user gives it; events change it.
#[derive(Debug, Clone)]
pub struct Law {
    spring: f64,
    loss: Loss,
    dashpot: Dashpot,
    shear: f64,
    attraction: f64,
    global_damping: f64,
    /// Of grains that rotate.
    friction: Option<friction::Given>,
}

/// What contacts lose.
#[derive(Debug, Clone, Copy)]
enum Loss {
    /// N·s/m, for grains and walls alike.
    Damping(f64),
    /// Speed after over speed before; the same for grains and walls.
    Restitution(f64),
}

impl Law {
    /// Of grains of so many kilograms that are expected to meet with at most `speed` m/s.
    pub fn new(grains: &Grains, dimensions: Dimensions, mass: f64, speed: f64, report: &mut Report) -> Self {
        let friction = friction::Given::new(grains, dimensions, mass, speed);
        if let Some(friction) = &friction {
            // What is missing has been told.
            let restitution = grains.restitution.unwrap_or(1.0);
            let by_time = |time| friction.spring(time, restitution);
            return Self {
                spring: grains.spring.or(grains.contact_time.map(by_time)).unwrap_or(1.0),
                loss: Loss::Restitution(restitution),
                dashpot: Dashpot::Normal,
                shear: 0.0,
                attraction: 0.0,
                global_damping: grains.global_damping,
                friction: Some(friction.clone()),
            };
        }
        let loss = loss("grains", grains.damping, grains.restitution, report).unwrap_or_else(|| {
            if grains.damping.is_none() {
                report.problem(
                    "grains",
                    "neither `restitution` nor `damping` is given",
                    "add \"restitution\": 0.5 (1 loses nothing), or a `damping` in N·s/m",
                );
            }
            Loss::Damping(0.0)
        });
        Self {
            spring: grains.spring.unwrap_or(1.0),
            loss,
            dashpot: grains.dashpot,
            shear: grains.shear,
            attraction: grains.attraction,
            global_damping: grains.global_damping,
            friction,
        }
    }

    /// The law after an event; a given restitution keeps holding when only the spring changes.
    pub fn changed(&self, path: &str, change: &Change, report: &mut Report) -> Self {
        Self {
            spring: change.spring.unwrap_or(self.spring),
            loss: loss(path, change.damping, change.restitution, report).unwrap_or(self.loss),
            dashpot: self.dashpot,
            shear: change.shear.unwrap_or(self.shear),
            attraction: change.attraction.unwrap_or(self.attraction),
            global_damping: change.global_damping.unwrap_or(self.global_damping),
            friction: self.friction.clone(),
        }
    }

    /// Coefficients for grains of `mass` kilograms.
    pub fn contact(&self, mass: f64) -> Contact {
        if let (Some(friction), Loss::Restitution(restitution)) = (&self.friction, self.loss) {
            return Contact {
                spring: 0.0,
                damping: 0.0,
                wall_damping: 0.0,
                dashpot: self.dashpot,
                shear: 0.0,
                attraction: 0.0,
                global_damping: self.global_damping,
                friction: Some(Box::new(friction.friction(self.spring, restitution))),
            };
        }
        let (damping, wall_damping) = match self.loss {
            Loss::Damping(both) => (both, both),
            Loss::Restitution(e) => {
                let critical = |effective_mass: f64| 2.0 * (self.spring * effective_mass).sqrt();
                let beta = damping_ratio(e);
                (beta * critical(mass / 2.0), beta * critical(mass))
            }
        };
        Contact {
            spring: self.spring,
            damping,
            wall_damping,
            dashpot: self.dashpot,
            shear: self.shear,
            attraction: self.attraction,
            global_damping: self.global_damping,
            friction: None,
        }
    }
}

fn loss(path: &str, damping: Option<f64>, restitution: Option<f64>, report: &mut Report) -> Option<Loss> {
    match (damping, restitution) {
        (Some(_), Some(_)) => {
            report.problem(
                path,
                "both `damping` and `restitution` are given, and each sets the dashpot",
                "remove one of them",
            );
            None
        }
        (Some(damping), None) => Some(Loss::Damping(damping)),
        (None, Some(restitution)) => Some(Loss::Restitution(restitution)),
        (None, None) => None,
    }
}

/// β = −ln e / √(π² + ln² e).
pub fn damping_ratio(restitution: f64) -> f64 {
    let ln = restitution.ln();
    -ln / (PI * PI + ln * ln).sqrt()
}

impl Contact {
    /// Seconds that the shorter of a contact of two grains and one at a wall lasts.
    ///
    /// The attraction, which grows with distance, stiffens a contact and is added to the spring. A contact that is
    /// damped beyond β = 1 never swings back; there it is π m_eff / η, the time in which its speed fades.
    pub fn duration(&self, mass: f64) -> f64 {
        if let Some(friction) = &self.friction {
            return friction.duration;
        }
        let half_period = |effective_mass: f64, damping: f64| {
            let omega = ((self.spring + self.attraction) / effective_mass).sqrt();
            let beta = damping / (2.0 * effective_mass * omega);
            if beta < 1.0 {
                PI / (omega * (1.0 - beta * beta).sqrt())
            } else {
                PI * effective_mass / damping
            }
        };
        half_period(mass / 2.0, self.damping).min(half_period(mass, self.wall_damping))
    }

    /// Rate at which dashpot, shear and global damping slow a contact of two grains, 1/s; walls slow it less.
    pub fn damping_rate(&self, mass: f64) -> f64 {
        if let Some(friction) = &self.friction {
            return friction.damping_rate + self.global_damping;
        }
        (self.damping + self.shear) / (mass / 2.0) + self.global_damping
    }
}
