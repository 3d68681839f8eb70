//! What `sliceflow bench` measures: the same scenes on every machine, each at any number of particles.

use serde_json::{Value, json};

use crate::error::Result;
use crate::scene::Scene;
use crate::study::scenes::parse;

/// One scene of the set. To add one: a row of [`SUBJECTS`].
pub struct Subject {
    /// For `--scene` and reports.
    pub name: &'static str,
    pub about: &'static str,
    /// The scene with about so many particles, boundary particles apart.
    pub scene: fn(u32) -> Result<Scene>,
    /// Whether pictures of it are measured; they cost the same whatever moves the particles.
    pub pictures: bool,
}

pub const SUBJECTS: &[Subject] = &[
    Subject {
        name: "water_still",
        about: "a tank of water at rest, wcsph",
        scene: |n| still(n),
        pictures: false,
    },
    Subject {
        name: "water_splash",
        about: "nine balls of water fall into a pool, wcsph",
        scene: |n| splash(n, "wcsph"),
        pictures: true,
    },
    Subject {
        name: "water_splash_dfsph",
        about: "the same, dfsph",
        scene: |n| splash(n, "dfsph"),
        pictures: false,
    },
    Subject {
        name: "water_2d",
        about: "a column of water collapses in 2D, wcsph",
        scene: |n| flat_column(n),
        pictures: false,
    },
    Subject {
        name: "grains_settled",
        about: "a packed bed of grains",
        scene: |n| settled(n),
        pictures: true,
    },
    Subject {
        name: "grains_falling",
        about: "half of the grains rain onto a bed of the other half",
        scene: |n| falling(n),
        pictures: false,
    },
    Subject {
        name: "grains_2d",
        about: "a bed of discs in 2D",
        scene: |n| flat_bed(n),
        pictures: true,
    },
];

const PICTURE: [u32; 2] = [1280, 720];
/// Of grains, metres.
const RADIUS: f64 = 0.005;

fn file(name: &str, rest: Value) -> Result<Scene> {
    let mut file =
        json!({ "name": name, "time": { "duration": 1, "fps": 60 }, "render": { "size": PICTURE } });
    for (key, value) in rest.as_object().into_iter().flatten() {
        file[key] = value.clone();
    }
    parse(&file)
}

/// Distance of `n` particles that fill a volume (an area in 2D).
fn spacing(volume: f64, n: u32, dimensions: f64) -> f64 {
    (volume / f64::from(n)).powf(1.0 / dimensions)
}

fn still(n: u32) -> Result<Scene> {
    file(
        "water_still",
        json!({
            "domain": { "min": [0, 0, 0], "max": [1, 0.8, 1], "sides": { "y_max": "open" } },
            "fluid": { "solver": "wcsph", "spacing": spacing(0.5, n, 3.0), "artificial_viscosity": 0.05 },
            "bodies": [{ "shape": { "kind": "box", "min": [0, 0, 0], "max": [1, 0.5, 1] }, "pressure": "hydrostatic" }]
        }),
    )
}

fn splash(n: u32, solver: &str) -> Result<Scene> {
    const POOL: f64 = 0.3;
    const BALL: f64 = 0.13;
    let ball = 4.0 / 3.0 * std::f64::consts::PI * BALL.powi(3);
    let spacing = spacing(POOL + 9.0 * ball, n, 3.0);
    let mut bodies = vec![json!({
        "shape": { "kind": "box", "min": [0, 0, 0], "max": [1, POOL, 1] }, "pressure": "hydrostatic"
    })];
    for x in [0.2, 0.5, 0.8] {
        for z in [0.2, 0.5, 0.8] {
            // Some have just begun to dive, others are on their way.
            let height = POOL + BALL + spacing * (1.0 + 2.0 * f64::from((10.0 * (x + z)) as i32 % 3));
            bodies.push(json!({
                "shape": { "kind": "sphere", "center": [x, height, z], "radius": BALL }, "velocity": [0, -3, 0]
            }));
        }
    }
    file(
        "water_splash",
        json!({
            "domain": { "min": [0, 0, 0], "max": [1, 1, 1], "sides": { "y_max": "open" } },
            "fluid": { "solver": solver, "spacing": spacing, "artificial_viscosity": 0.05, "max_speed": 4 },
            "bodies": bodies
        }),
    )
}

fn flat_column(n: u32) -> Result<Scene> {
    file(
        "water_2d",
        json!({
            "dimensions": 2,
            "domain": { "min": [0, 0], "max": [2, 1.2], "sides": { "y_max": "open" } },
            "fluid": { "solver": "wcsph", "spacing": spacing(0.5, n, 2.0), "artificial_viscosity": 0.05 },
            "bodies": [{ "shape": { "kind": "box", "min": [0, 0], "max": [0.5, 1] }, "pressure": "hydrostatic" }]
        }),
    )
}

fn grains() -> Value {
    json!({ "radius": RADIUS, "density": 2500, "spring": 2e4, "restitution": 0.5, "shear": 0.5 })
}

/// Sides of a block of about `n` grains, twice as wide as high, in grains: across and high.
fn block(n: u32, dimensions: i32) -> [f64; 2] {
    let across = (2.0 * f64::from(n))
        .powf(1.0 / f64::from(dimensions))
        .round()
        .max(2.0);
    [
        across,
        (f64::from(n) / across.powi(dimensions - 1)).round().max(1.0),
    ]
}

fn settled(n: u32) -> Result<Scene> {
    let [width, height] = block(n, 3).map(|grains| 2.0 * RADIUS * grains);
    file(
        "grains_settled",
        json!({
            "domain": { "min": [0, 0, 0], "max": [width, 1.5 * height, width] },
            "grains": grains(),
            "bodies": [{ "shape": { "kind": "box", "min": [0, 0, 0], "max": [width, height, width] } }]
        }),
    )
}

fn falling(n: u32) -> Result<Scene> {
    // One grain in so many diameters' cube falls.
    const APART: f64 = 1.5;
    let [width, height] = block(n / 2, 3).map(|grains| 2.0 * RADIUS * grains);
    let high = height * APART.powi(3);
    let (low, top) = (height + RADIUS, height + RADIUS + high);
    file(
        "grains_falling",
        json!({
            "domain": { "min": [0, 0, 0], "max": [width, top + 2.0 * RADIUS, width] },
            "grains": grains(),
            "bodies": [
                { "shape": { "kind": "box", "min": [0, 0, 0], "max": [width, height, width] } },
                {
                    "shape": { "kind": "box", "min": [0, low, 0], "max": [width, top, width] },
                    "spacing": 2.0 * RADIUS * APART, "jitter": 0.15, "velocity": [0, -2, 0]
                }
            ]
        }),
    )
}

fn flat_bed(n: u32) -> Result<Scene> {
    let [width, height] = block(n, 2).map(|grains| 2.0 * RADIUS * grains);
    file(
        "grains_2d",
        json!({
            "dimensions": 2,
            "domain": { "min": [0, 0], "max": [width, 1.5 * height] },
            "grains": { "radius": RADIUS, "density": 2500, "spring": 4e5, "restitution": 0.5, "shear": 40 },
            "bodies": [{ "shape": { "kind": "box", "min": [0, 0], "max": [width, height] } }],
            "render": { "size": PICTURE, "splat": "disc" }
        }),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_has_about_the_number_of_particles_that_it_is_asked_for() {
        for subject in SUBJECTS {
            for n in [1_000, 16_000] {
                let scene = (subject.scene)(n).unwrap_or_else(|error| panic!("{}: {error}", subject.name));
                let ratio = f64::from(scene.first_boundary()) / f64::from(n);
                assert!((0.75..1.3).contains(&ratio), "{}: {ratio} of {n}", subject.name);
            }
        }
    }
}
