//! Contacts of grains that rotate and rub: from what a user gives to coefficients.
//!
//! A contact of effective mass m* (m/2 for two grains, m at a wall) has the damping ratio β = −ln e / √(π² + ln² e), across and
//! along. Along it, what moves is the surface: its effective mass is m* / (1 + m R² / I), for turning is easier than moving.
//! Walls are rigid unless their material says otherwise, so that Hertz's R*, E* and G* are there R, E/(1 − ν²) and G/(2 − ν);
//! for two grains, half of each.
//!
//! Of grains of several sizes these are the coefficients of the largest; shaders make those of each pair of them
//! (`shaders/physics/dem/friction.wgsl`).

use std::f64::consts::PI;

use super::Dimensions;
use super::contact::damping_ratio;
use super::grain_materials::{Materials, Rub};
use super::model::{ContactLaw, Grains, RollingResistance};

/// How far neighbors are searched, in diameters: grains that are about to touch, or have just parted, matter for half a step
/// (`shaders/physics/dem/friction.wgsl`). A step would have to move a grain by 4 % of a diameter to leave that out.
pub const REACH: f64 = 1.02;

/// Range of cohesion when left out, in radii.
const USUAL_RANGE: f64 = 0.1;
/// Coulomb's coefficient when left out.
const USUAL_FRICTION: f64 = 0.5;
/// Poisson's ratio when left out.
const USUAL_POISSON_RATIO: f64 = 0.25;
/// Share of critical damping of the spring that resists rolling (Ai et al. 2011).
const ROLLING_DAMPING: f64 = 0.3;
/// Share of the speed of sound in a grain that grains are expected to meet with at least.
const SLOWEST_IMPACT: f64 = 1e-4;

/// Coefficients of a contact: of two grains, or of a grain and a wall. Of `hertz` they are to be multiplied by powers of the
/// overlap δ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pairing {
    /// N/m; of `hertz` N/m^(3/2), times δ^(3/2) a force.
    pub stiffness: f64,
    /// N·s/m; of `hertz` times δ^(1/4).
    pub damping: f64,
    /// N/m; of `hertz` times √δ.
    pub shear_stiffness: f64,
    /// N·s/m; of `hertz` times δ^(1/4).
    pub shear_damping: f64,
    /// Tangential over normal force, at most.
    pub friction: f64,
    /// Torque over normal force, at most, metres.
    pub rolling_limit: f64,
    /// N·m per radian, over the normal stiffness, m².
    pub rolling_stiffness: f64,
    /// N·m·s, over the square root of the rolling stiffness.
    pub rolling_damping: f64,
    /// Of rolling about the contact, kg·m².
    pub rolling_inertia: f64,
    /// Greatest pull, N.
    pub cohesion: f64,
}

/// The contact law of grains that rotate.
#[derive(Debug, Clone, PartialEq)]
pub struct Friction {
    /// `linear` or `hertz`.
    pub law: ContactLaw,
    /// Of the material `grains`.
    pub grains: Pairing,
    pub walls: Pairing,
    /// Number of materials, that of `grains` included.
    pub materials: usize,
    /// Of grains of two materials, then of a grain and a wall: row by row, a row of those for each material of grains. Empty
    /// where there is one material.
    pub pairings: Vec<Pairing>,
    /// Distance of surfaces at which cohesion ends, metres; 0 where there is none.
    pub cohesion_range: f64,
    pub rolling: Option<RollingResistance>,
    /// Of a grain about its center, kg·m².
    pub inertia: f64,
    /// Seconds that the shortest half swing of a contact lasts, across or along; of `hertz`, at the greatest expected speed.
    pub duration: f64,
    /// How fast a dashpot slows a contact, 1/s.
    pub damping_rate: f64,
}

impl Friction {
    /// How far neighbors are searched, in diameters, for grains of this radius.
    pub fn reach(&self, radius: f64) -> f64 {
        REACH + self.cohesion_range / (2.0 * radius)
    }
}

/// What of it no event changes.
#[derive(Debug, Clone)]
pub struct Given {
    law: ContactLaw,
    young_modulus: f64,
    poisson_ratio: f64,
    /// Between grains; an event may change the restitution.
    rub: Rub,
    wall_friction: f64,
    materials: Materials,
    /// Metres.
    cohesion_range: f64,
    tangential_stiffness: Option<f64>,
    rolling: Option<RollingResistance>,
    /// Metres.
    radius: f64,
    dimensions: Dimensions,
    /// Kilograms.
    mass: f64,
    /// With which grains are expected to meet at most, m/s.
    speed: f64,
}

impl Given {
    /// `None` for a law without rotation. `mass` in kilograms; `speed`, with which grains are expected to meet at most, in m/s.
    pub fn new(grains: &Grains, dimensions: Dimensions, mass: f64, speed: f64) -> Option<Self> {
        if grains.law == ContactLaw::SpringDashpot {
            return None;
        }
        let friction = grains.friction.unwrap_or(USUAL_FRICTION);
        let rolls = rolls(grains);
        let sticks = sticks(grains);
        let rub = Rub {
            friction,
            rolling_friction: grains.rolling_friction.unwrap_or(0.0),
            restitution: grains.restitution.unwrap_or(1.0),
            cohesion: grains.cohesion.unwrap_or(0.0),
        };
        let young_modulus = grains.young_modulus.unwrap_or(1.0);
        let sound = (young_modulus / grains.density).sqrt();
        Some(Self {
            law: grains.law,
            young_modulus,
            poisson_ratio: grains.poisson_ratio.unwrap_or(USUAL_POISSON_RATIO),
            rub,
            wall_friction: grains.wall_friction.unwrap_or(friction),
            materials: Materials::new(grains),
            cohesion_range: if sticks { cohesion_range(grains) } else { 0.0 },
            tangential_stiffness: grains.tangential_stiffness,
            rolling: rolls.then(|| grains.rolling_resistance.unwrap_or_default()),
            radius: grains.radius,
            dimensions,
            mass,
            speed: speed.max(SLOWEST_IMPACT * sound),
        })
    }

    /// The spring with which a contact of two grains of this restitution lasts so many seconds, N/m.
    pub fn spring(&self, contact_time: f64, restitution: f64) -> f64 {
        let ln = restitution.ln();
        self.mass / 2.0 * (PI * PI + ln * ln) / (contact_time * contact_time)
    }

    /// Coefficients, of `linear` with this spring, N/m.
    pub fn friction(&self, spring: f64, restitution: f64) -> Friction {
        let own = Rub {
            restitution,
            ..self.rub
        };
        let at_walls = Rub {
            friction: self.wall_friction,
            ..own
        };
        let count = self.materials.count();
        let numbers = (0..count * count).map(|k| (k / count, k % count));
        let of_grains = numbers.clone().map(|(a, b)| {
            let rub = self.materials.of_grains(own, a, b);
            self.met(rub, self.solid(a, spring), Some(self.solid(b, spring)), false)
        });
        let of_walls = numbers.map(|(a, b)| {
            let rub = self.materials.at_wall(at_walls, a, b);
            self.met(rub, self.solid(a, spring), self.wall(b, spring), true)
        });
        let all: Vec<Met> = of_grains.chain(of_walls).collect();
        let pairings = all.iter().map(|met| met.pairing);
        Friction {
            law: self.law,
            grains: all[0].pairing,
            walls: all[count * count].pairing,
            materials: count,
            pairings: if count > 1 { pairings.collect() } else { Vec::new() },
            cohesion_range: self.cohesion_range,
            rolling: self.rolling,
            inertia: self.shape() * self.mass * self.radius.powi(2),
            duration: all.iter().map(|met| met.duration).fold(f64::INFINITY, f64::min),
            damping_rate: all.iter().map(|met| met.damping_rate).fold(0.0, f64::max),
        }
    }

    /// I/(m R²).
    fn shape(&self) -> f64 {
        match self.dimensions {
            Dimensions::Two => 1.0 / 2.0,
            Dimensions::Three => 2.0 / 5.0,
        }
    }

    /// How stiff a material is, where `grains` has this spring, N/m.
    fn solid(&self, number: usize, spring: f64) -> Solid {
        let own = self.materials.get(number);
        Solid {
            spring: own.and_then(|own| own.spring).unwrap_or(spring),
            young_modulus: own
                .and_then(|own| own.young_modulus)
                .unwrap_or(self.young_modulus),
            poisson_ratio: own
                .and_then(|own| own.poisson_ratio)
                .unwrap_or(self.poisson_ratio),
        }
    }

    /// The same of a wall; `None` where it is rigid.
    fn wall(&self, number: usize, spring: f64) -> Option<Solid> {
        let own = self.materials.get(number)?;
        (own.spring.is_some() || own.young_modulus.is_some()).then(|| self.solid(number, spring))
    }

    /// A contact of a grain with another grain, or with a wall.
    fn met(&self, rub: Rub, grain: Solid, other: Option<Solid>, is_wall: bool) -> Met {
        // What share of a grain's mass and radius is effective.
        let share = if is_wall { 1.0 } else { 0.5 };
        let (mass, radius) = (share * self.mass, share * self.radius);
        let shape = self.shape();
        let surface_mass = mass * shape / (1.0 + shape);
        let beta = damping_ratio(rub.restitution);
        let stiff = Stiffness::of(grain, other);
        let met = match self.law {
            ContactLaw::Hertz => self.hertz(&stiff, mass, radius, beta),
            _ => self.linear(stiff.spring, mass, surface_mass, beta),
        };
        let rolling_inertia = share * (shape + 1.0) * self.mass * self.radius.powi(2);
        let arm = rub.rolling_friction * radius;
        // The pull changes with the distance like the force of a spring.
        let bridge = match self.cohesion_range > 0.0 {
            true => rub.cohesion / self.cohesion_range,
            false => 0.0,
        };
        Met {
            pairing: Pairing {
                friction: rub.friction,
                rolling_limit: arm,
                rolling_stiffness: 2.25 * arm * arm,
                rolling_damping: 2.0 * ROLLING_DAMPING * rolling_inertia.sqrt(),
                rolling_inertia,
                cohesion: rub.cohesion,
                ..met.pairing
            },
            duration: match bridge > 0.0 {
                true => met.duration.min(PI / (bridge / mass).sqrt()),
                false => met.duration,
            },
            ..met
        }
    }

    fn linear(&self, spring: f64, mass: f64, surface_mass: f64, beta: f64) -> Met {
        let ratio = self.tangential_stiffness.unwrap_or(surface_mass / mass);
        let shear_stiffness = ratio * spring;
        let fastest = (spring / mass).max(shear_stiffness / surface_mass).sqrt();
        Met {
            pairing: Pairing {
                stiffness: spring,
                damping: 2.0 * beta * (spring * mass).sqrt(),
                shear_stiffness,
                shear_damping: 2.0 * beta * (shear_stiffness * surface_mass).sqrt(),
                ..NOTHING
            },
            duration: PI / (fastest * (1.0 - beta * beta).sqrt()),
            damping_rate: 2.0 * beta * fastest,
        }
    }

    fn hertz(&self, stiff: &Stiffness, mass: f64, radius: f64, beta: f64) -> Met {
        let stiffness = 4.0 / 3.0 * stiff.young * radius.sqrt();
        let shear_stiffness = 8.0 * stiff.shear * radius.sqrt();
        let pairing = Pairing {
            stiffness,
            damping: 5f64.sqrt() * beta * (stiffness * mass).sqrt(),
            shear_stiffness,
            shear_damping: 2.0 * (5.0 / 6.0f64).sqrt() * beta * (shear_stiffness * mass).sqrt(),
            ..NOTHING
        };
        let deepest = (1.25 * mass * self.speed * self.speed / stiffness).powf(0.4);
        // Along the contact, surfaces swing faster by this.
        let faster = (shear_stiffness / (1.5 * stiffness) * (1.0 + 1.0 / self.shape()))
            .sqrt()
            .max(1.0);
        Met {
            pairing,
            duration: HERTZ_DURATION * deepest / self.speed / faster,
            damping_rate: pairing.damping * deepest.powf(0.25) / mass * faster,
        }
    }
}

/// Distance of surfaces at which cohesion ends, where grains stick, metres.
pub fn cohesion_range(grains: &Grains) -> f64 {
    grains.cohesion_range.unwrap_or(USUAL_RANGE * grains.radius)
}

/// Whether anything of a scene resists rolling.
pub fn rolls(grains: &Grains) -> bool {
    let materials = grains.materials.iter().map(|material| material.rolling_friction);
    let pairs = grains.pairs.iter().map(|pair| pair.rolling_friction);
    let all = std::iter::once(grains.rolling_friction)
        .chain(materials)
        .chain(pairs);
    all.flatten().any(|friction| friction > 0.0)
}

/// Whether anything of a scene sticks.
pub fn sticks(grains: &Grains) -> bool {
    let materials = grains.materials.iter().map(|material| material.cohesion);
    let pairs = grains.pairs.iter().map(|pair| pair.cohesion);
    let all = std::iter::once(grains.cohesion).chain(materials).chain(pairs);
    all.flatten().any(|cohesion| cohesion > 0.0)
}

/// How stiff a material is.
#[derive(Debug, Clone, Copy)]
struct Solid {
    /// N/m.
    spring: f64,
    /// Pa.
    young_modulus: f64,
    poisson_ratio: f64,
}

/// Of two solids, one after the other.
struct Stiffness {
    /// N/m.
    spring: f64,
    /// E* and G*, Pa.
    young: f64,
    shear: f64,
}

impl Stiffness {
    /// Of a grain with what it touches; with a rigid wall where that is `None`.
    fn of(grain: Solid, other: Option<Solid>) -> Self {
        let both = [Some(grain), other];
        let sum = |yields: fn(&Solid) -> f64| both.iter().flatten().map(yields).sum::<f64>();
        Self {
            // Two equal springs are the spring of their contact.
            spring: match other {
                Some(other) => 2.0 / (1.0 / grain.spring + 1.0 / other.spring),
                None => grain.spring,
            },
            young: 1.0 / sum(|solid| (1.0 - solid.poisson_ratio.powi(2)) / solid.young_modulus),
            shear: 1.0
                / sum(|solid| {
                    2.0 * (1.0 + solid.poisson_ratio) * (2.0 - solid.poisson_ratio) / solid.young_modulus
                }),
        }
    }
}

/// Coefficients of a contact, with how long half a swing lasts, seconds, and how fast dashpots slow it, 1/s.
struct Met {
    pairing: Pairing,
    duration: f64,
    damping_rate: f64,
}

/// Duration of an elastic impact, in greatest overlaps over the speed: 2 ∫ dx / √(1 − x^(5/2)) from 0 to 1.
const HERTZ_DURATION: f64 = 2.943_275;

const NOTHING: Pairing = Pairing {
    stiffness: 0.0,
    damping: 0.0,
    shear_stiffness: 0.0,
    shear_damping: 0.0,
    friction: 0.0,
    rolling_limit: 0.0,
    rolling_stiffness: 0.0,
    rolling_damping: 0.0,
    rolling_inertia: 0.0,
    cohesion: 0.0,
};

/// The speed with which grains are expected to meet at most, m/s: that of the fastest, and that of a fall through the whole
/// domain.
pub fn expected_speed(fastest: f64, gravity: f64, height: f64) -> f64 {
    (4.0 * fastest * fastest + 2.0 * gravity * height).sqrt()
}
