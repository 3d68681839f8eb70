//! The solvers that are tried, and scenes of each.

use serde_json::{Value, json};

use crate::error::Result;
use crate::scene::Scene;
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

/// A solver as it is tried here: a row of [`METHODS`].
#[derive(Clone, Copy)]
pub struct Method {
    pub name: &'static str,
    pub is_fluid: bool,
    /// Whether its steps have one length unless a scene asks for others. Those without have no speed of sound that would limit
    /// such a step.
    pub has_fixed_steps: bool,
    /// Whether still water has to begin with the pressure of its depth.
    pub begins_with_pressure: bool,
    /// Puts the matter into the scene.
    matter: fn(&mut Value),
}

pub const METHODS: [Method; 6] = [
    Method {
        name: "sph",
        is_fluid: true,
        has_fixed_steps: true,
        begins_with_pressure: false,
        matter: |file| fluid(file, json!({ "solver": "sph", "density_from": "summation" })),
    },
    Method {
        name: "wcsph, continuity",
        is_fluid: true,
        has_fixed_steps: true,
        begins_with_pressure: true,
        matter: |file| fluid(file, json!({ "solver": "wcsph", "density_from": "continuity" })),
    },
    Method {
        name: "wcsph, summation",
        is_fluid: true,
        has_fixed_steps: true,
        begins_with_pressure: false,
        matter: |file| fluid(file, json!({ "solver": "wcsph", "density_from": "summation" })),
    },
    Method {
        name: "dfsph",
        is_fluid: true,
        has_fixed_steps: false,
        begins_with_pressure: false,
        matter: |file| fluid(file, json!({ "solver": "dfsph" })),
    },
    Method {
        name: "DEM, symplectic Euler",
        is_fluid: false,
        has_fixed_steps: true,
        begins_with_pressure: false,
        matter: |file| grains(file, "symplectic_euler"),
    },
    Method {
        name: "DEM, velocity Verlet",
        is_fluid: false,
        has_fixed_steps: true,
        begins_with_pressure: false,
        matter: |file| grains(file, "velocity_verlet"),
    },
];

/// Those whose longest stable step can be asked for.
pub fn with_fixed_steps() -> impl Iterator<Item = Method> {
    METHODS.into_iter().filter(|method| method.has_fixed_steps)
}

fn fluid(file: &mut Value, mut own: Value) {
    own["spacing"] = SPACING.into();
    own["density"] = DENSITY.into();
    own["artificial_viscosity"] = 0.05.into();
    file["fluid"] = own;
}

fn grains(file: &mut Value, integrator: &str) {
    let radius = SPACING / 2.0;
    let mass = match file["dimensions"].as_u64() {
        Some(3) => DENSITY * 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3),
        _ => DENSITY * std::f64::consts::PI * radius * radius,
    };
    // m v² = k δ²
    let spring = mass * (EXPECTED / (OVERLAP * radius)).powi(2);
    file["grains"] = json!({
        "radius": radius, "density": DENSITY, "spring": spring, "restitution": RESTITUTION
    });
    file["time"]["integrator"] = integrator.into();
}

impl Method {
    /// A scene of this method in the unit square; `change` completes the file.
    pub fn scene(self, body: Value, change: impl FnOnce(&mut Value)) -> Result<Scene> {
        self.scene_in(json!({ "min": [0, 0], "max": [1, 1] }), 2, body, change)
    }

    /// The same in the unit cube.
    pub fn solid_scene(self, body: Value, change: impl FnOnce(&mut Value)) -> Result<Scene> {
        self.scene_in(json!({ "min": [0, 0, 0], "max": [1, 1, 1] }), 3, body, change)
    }

    fn scene_in(
        self,
        domain: Value,
        dimensions: u32,
        body: Value,
        change: impl FnOnce(&mut Value),
    ) -> Result<Scene> {
        let mut file = json!({
            "name": self.name,
            "dimensions": dimensions,
            "domain": domain,
            "bodies": [body],
            "time": { "fps": 1000 },
        });
        (self.matter)(&mut file);
        change(&mut file);
        parse(&file)
    }
}

/// A block of so many particles.
pub fn block(low: [f64; 2], columns: u32, rows: u32) -> Value {
    block_of(low, [columns, rows])
}

/// A block of so many particles along each axis.
pub fn block_of<const N: usize>(low: [f64; N], counts: [u32; N]) -> Value {
    // A little more, so that rounding takes no row away.
    let along = |axis: usize| low[axis] + (f64::from(counts[axis]) + 1e-6) * SPACING;
    let high: Vec<f64> = (0..N).map(along).collect();
    json!({ "shape": { "kind": "box", "min": low.to_vec(), "max": high } })
}
