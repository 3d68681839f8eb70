//! The solvers that are tried, and scenes of each.

use serde_json::{Value, json};

use crate::error::Result;
use crate::scene::Scene;
use crate::scene::model::Integrator;
use crate::study::scenes::parse;

/// Distance of particles in all scenes here, metres; grains have this diameter.
pub const SPACING: f64 = 0.025;
/// Speed that a fluid's sound and a grain's spring are made for, m/s.
pub const EXPECTED: f64 = 1.0;
/// How far a grain at that speed presses into a wall, as a share of its radius.
const OVERLAP: f64 = 0.15;
/// kg/m³.
const DENSITY: f64 = 1000.0;
/// Of grains.
pub const RESTITUTION: f64 = 0.5;

#[derive(Clone, Copy, PartialEq)]
pub enum Method {
    Fluid {
        name: &'static str,
        solver: &'static str,
        density_from: &'static str,
    },
    Grains {
        name: &'static str,
        integrator: Integrator,
    },
}

pub const FLUIDS: [Method; 3] = [
    fluid("sph", "sph", "summation"),
    fluid("wcsph, continuity", "wcsph", "continuity"),
    fluid("wcsph, summation", "wcsph", "summation"),
];

/// Has no steps of one length, and no sound.
pub const INCOMPRESSIBLE: Method = fluid("dfsph", "dfsph", "summation");

pub const GRAINS: [Method; 2] = [
    grains("DEM, symplectic Euler", Integrator::SymplecticEuler),
    grains("DEM, velocity Verlet", Integrator::VelocityVerlet),
];

const fn fluid(name: &'static str, solver: &'static str, density_from: &'static str) -> Method {
    Method::Fluid {
        name,
        solver,
        density_from,
    }
}

const fn grains(name: &'static str, integrator: Integrator) -> Method {
    Method::Grains { name, integrator }
}

impl Method {
    pub fn name(self) -> &'static str {
        match self {
            Self::Fluid { name, .. } | Self::Grains { name, .. } => name,
        }
    }

    /// A scene of this method in the unit square; `change` completes the file.
    pub fn scene(self, body: Value, change: impl FnOnce(&mut Value)) -> Result<Scene> {
        let mut file = json!({
            "name": self.name(),
            "dimensions": 2,
            "domain": { "min": [0, 0], "max": [1, 1] },
            "bodies": [body],
            "time": { "fps": 1000 },
        });
        match self {
            Self::Fluid {
                solver, density_from, ..
            } => {
                file["fluid"] = json!({
                    "solver": solver, "spacing": SPACING, "density": DENSITY, "artificial_viscosity": 0.05
                });
                if self != INCOMPRESSIBLE {
                    file["fluid"]["density_from"] = density_from.into();
                }
            }
            Self::Grains { integrator, .. } => {
                let radius = SPACING / 2.0;
                let mass = DENSITY * std::f64::consts::PI * radius * radius;
                // m v² = k δ²
                let spring = mass * (EXPECTED / (OVERLAP * radius)).powi(2);
                file["grains"] = json!({
                    "radius": radius, "density": DENSITY, "spring": spring, "restitution": RESTITUTION
                });
                file["time"]["integrator"] = json!(integrator);
            }
        }
        change(&mut file);
        parse(&file)
    }

    /// Whether its steps have one length unless a scene asks for others.
    pub fn has_fixed_steps(self) -> bool {
        self != INCOMPRESSIBLE
    }

    pub fn is_fluid(self) -> bool {
        matches!(self, Self::Fluid { .. })
    }
}

/// A block of so many particles.
pub fn block(low: [f64; 2], columns: u32, rows: u32) -> Value {
    // A little more, so that rounding takes no row away.
    let along = |n: u32| (f64::from(n) + 1e-6) * SPACING;
    let high = [low[0] + along(columns), low[1] + along(rows)];
    json!({ "shape": { "kind": "box", "min": low, "max": high } })
}
