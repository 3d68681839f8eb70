//! From what the user gives about contacts to coefficients, and how long a contact lasts.
//!
//! A head-on contact is a damped oscillator of mass m_eff (m/2 for two grains, m at a wall), spring k and dashpot η:
//! ω₀ = √(k / m_eff), damping ratio β = η / (2 √(k m_eff)). It ends after half a period, and
//! restitution e = exp(−π β / √(1 − β²)).

use std::f64::consts::PI;

use super::friction;
use super::model::{Change, Dashpot, Grains, Sizes};
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
    smallest: Option<Smallest>,
}

/// The law of the smallest of grains of several sizes.
#[derive(Debug, Clone)]
struct Smallest {
    law: Box<Law>,
    /// Kilograms.
    mass: f64,
    /// Spring over that of the largest.
    spring: f64,
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
    /// Of grains of so many kilograms, those of the largest, that are expected to meet with at most `speed` m/s.
    pub fn new(grains: &Grains, dimensions: Dimensions, mass: f64, speed: f64, report: &mut Report) -> Self {
        let largest = Self::of_one_size(grains, dimensions, mass, speed, report);
        let Some(radius) = grains.sizes.as_ref().map(Sizes::smallest) else {
            return largest;
        };
        let share = (radius / grains.radius).powi(dimensions.count() as i32);
        let grains = Grains {
            radius,
            // As far as that of all.
            cohesion_range: Some(friction::cohesion_range(grains)),
            ..grains.clone()
        };
        let mass = share * mass;
        // What is wrong has been told.
        let law = Self::of_one_size(&grains, dimensions, mass, speed, &mut Report::default());
        Self {
            smallest: Some(Smallest {
                spring: law.spring / largest.spring,
                law: Box::new(law),
                mass,
            }),
            ..largest
        }
    }

    fn of_one_size(
        grains: &Grains,
        dimensions: Dimensions,
        mass: f64,
        speed: f64,
        report: &mut Report,
    ) -> Self {
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
                smallest: None,
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
            smallest: None,
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
            smallest: self.smallest.as_ref().map(|smallest| {
                let change = Change {
                    spring: change.spring.map(|spring| smallest.spring * spring),
                    ..change.clone()
                };
                let law = smallest.law.changed(path, &change, &mut Report::default());
                Smallest {
                    law: Box::new(law),
                    ..smallest.clone()
                }
            }),
        }
    }

    /// Coefficients for grains of `mass` kilograms, those of the largest.
    pub fn contact(&self, mass: f64) -> Contact {
        let smallest = self
            .smallest
            .as_ref()
            .map(|smallest| (Box::new(smallest.law.contact(smallest.mass)), smallest.mass));
        Contact {
            smallest,
            ..self.of_largest(mass)
        }
    }

    fn of_largest(&self, mass: f64) -> Contact {
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
                smallest: None,
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
            smallest: None,
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
        let all = self
            .smallest
            .as_ref()
            .map_or(f64::INFINITY, |(law, mass)| law.duration(*mass));
        all.min(self.duration_of_largest(mass))
    }

    fn duration_of_largest(&self, mass: f64) -> f64 {
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
        let all = self
            .smallest
            .as_ref()
            .map_or(0.0, |(law, mass)| law.damping_rate(*mass));
        all.max(self.damping_rate_of_largest(mass))
    }

    fn damping_rate_of_largest(&self, mass: f64) -> f64 {
        if let Some(friction) = &self.friction {
            return friction.damping_rate + self.global_damping;
        }
        (self.damping + self.shear) / (mass / 2.0) + self.global_damping
    }
}
