//! Contacts of grains that rotate and rub: from what a user gives to coefficients.
//!
//! A contact of effective mass m* (m/2 for two grains, m at a wall) has the damping ratio β = −ln e / √(π² + ln² e), across and
//! along. Along it, what moves is the surface: its effective mass is m* / (1 + m R² / I), for turning is easier than moving.
//! Hertz's law takes walls as rigid, so that R*, E* and G* are there R, E/(1 − ν²) and G/(2 − ν); for two grains, half of
//! each.

use std::f64::consts::PI;

use super::Dimensions;
use super::contact::damping_ratio;
use super::model::{ContactLaw, Grains, RollingResistance};

/// How far neighbors are searched, in diameters: grains that are about to touch, or have just parted, matter for half a step
/// (`shaders/physics/dem/friction.wgsl`). A step would have to move a grain by 4 % of a diameter to leave that out.
pub const REACH: f64 = 1.02;

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
}

/// The contact law of grains that rotate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    /// `linear` or `hertz`.
    pub law: ContactLaw,
    pub grains: Pairing,
    pub walls: Pairing,
    pub rolling: Option<RollingResistance>,
    /// Of a grain about its center, kg·m².
    pub inertia: f64,
    /// Seconds that the shortest half swing of a contact lasts, across or along; of `hertz`, at the greatest expected speed.
    pub duration: f64,
    /// How fast a dashpot slows a contact, 1/s.
    pub damping_rate: f64,
}

/// What of it no event changes.
#[derive(Debug, Clone, Copy)]
pub struct Given {
    law: ContactLaw,
    young_modulus: f64,
    poisson_ratio: f64,
    /// Between grains, and at walls.
    friction: [f64; 2],
    tangential_stiffness: Option<f64>,
    rolling_friction: f64,
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
        let rolling_friction = grains.rolling_friction.unwrap_or(0.0);
        let rolls = rolling_friction > 0.0;
        let young_modulus = grains.young_modulus.unwrap_or(1.0);
        let sound = (young_modulus / grains.density).sqrt();
        Some(Self {
            law: grains.law,
            young_modulus,
            poisson_ratio: grains.poisson_ratio.unwrap_or(USUAL_POISSON_RATIO),
            friction: [friction, grains.wall_friction.unwrap_or(friction)],
            tangential_stiffness: grains.tangential_stiffness,
            rolling_friction,
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
        let shape = match self.dimensions {
            Dimensions::Two => 1.0 / 2.0,
            Dimensions::Three => 2.0 / 5.0,
        };
        let inertia = shape * self.mass * self.radius.powi(2);
        let beta = damping_ratio(restitution);
        // Two grains, then a grain and a wall: what share of a grain's mass and radius is effective, and the share of the
        // moduli.
        let [grains, walls] = [0.5, 1.0].map(|share: f64| {
            let mass = share * self.mass;
            let radius = share * self.radius;
            let surface_mass = mass * shape / (1.0 + shape);
            let (coefficients, duration, rate) = match self.law {
                ContactLaw::Hertz => self.hertz(mass, radius, share, beta, shape),
                _ => self.linear(spring, mass, surface_mass, beta),
            };
            let rolling_inertia = share * (inertia + self.mass * self.radius.powi(2));
            let arm = self.rolling_friction * radius;
            let pairing = Pairing {
                friction: self.friction[usize::from(share == 1.0)],
                rolling_limit: arm,
                rolling_stiffness: 2.25 * arm * arm,
                rolling_damping: 2.0 * ROLLING_DAMPING * rolling_inertia.sqrt(),
                rolling_inertia,
                ..coefficients
            };
            (pairing, duration, rate)
        });
        Friction {
            law: self.law,
            grains: grains.0,
            walls: walls.0,
            rolling: self.rolling,
            inertia,
            duration: grains.1.min(walls.1),
            damping_rate: grains.2.max(walls.2),
        }
    }

    /// With how long half a swing lasts, seconds, and how fast dashpots slow it, 1/s.
    fn linear(&self, spring: f64, mass: f64, surface_mass: f64, beta: f64) -> (Pairing, f64, f64) {
        let ratio = self.tangential_stiffness.unwrap_or(surface_mass / mass);
        let shear_stiffness = ratio * spring;
        let fastest = (spring / mass).max(shear_stiffness / surface_mass).sqrt();
        let pairing = Pairing {
            stiffness: spring,
            damping: 2.0 * beta * (spring * mass).sqrt(),
            shear_stiffness,
            shear_damping: 2.0 * beta * (shear_stiffness * surface_mass).sqrt(),
            ..NOTHING
        };
        (
            pairing,
            PI / (fastest * (1.0 - beta * beta).sqrt()),
            2.0 * beta * fastest,
        )
    }

    /// The same of elastic spheres; `share` is that of the moduli.
    fn hertz(&self, mass: f64, radius: f64, share: f64, beta: f64, shape: f64) -> (Pairing, f64, f64) {
        let poisson = self.poisson_ratio;
        let young = share * self.young_modulus / (1.0 - poisson * poisson);
        let shear = share * self.young_modulus / (2.0 * (1.0 + poisson)) / (2.0 - poisson);
        let stiffness = 4.0 / 3.0 * young * radius.sqrt();
        let shear_stiffness = 8.0 * shear * radius.sqrt();
        let pairing = Pairing {
            stiffness,
            damping: 5f64.sqrt() * beta * (stiffness * mass).sqrt(),
            shear_stiffness,
            shear_damping: 2.0 * (5.0 / 6.0f64).sqrt() * beta * (shear_stiffness * mass).sqrt(),
            ..NOTHING
        };
        let deepest = (1.25 * mass * self.speed * self.speed / stiffness).powf(0.4);
        // Along the contact, surfaces swing faster by this.
        let faster = (shear_stiffness / (1.5 * stiffness) * (1.0 + 1.0 / shape))
            .sqrt()
            .max(1.0);
        let duration = HERTZ_DURATION * deepest / self.speed / faster;
        (
            pairing,
            duration,
            pairing.damping * deepest.powf(0.25) / mass * faster,
        )
    }
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
};

/// The speed with which grains are expected to meet at most, m/s: that of the fastest, and that of a fall through the whole
/// domain.
pub fn expected_speed(fastest: f64, gravity: f64, height: f64) -> f64 {
    (4.0 * fastest * fastest + 2.0 * gravity * height).sqrt()
}
