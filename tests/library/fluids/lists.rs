//! Neighbor lists of fluids, which expect straight paths.

use std::path::Path;

use glam::Vec3;
use serde_json::json;
use sliceflow::plan::Wanted;
use sliceflow::scene::{Scene, load};

use crate::common;

const WIDTH: f64 = 2.0;

/// Two jets that pass each other two spacings apart, and a third one along the floor. They begin to meet within a frame. Were they
/// to meet head on, motion would be chaotic. All begin `shift` to the right, around a
/// periodic side if need be.
fn jets(sides: &str, shift: f64, skin: f64) -> Scene {
    let jet = |x: f64, y: f64, speed: f64| {
        let x = (x + shift) % WIDTH;
        json!({
            "shape": { "kind": "box", "min": [x, y], "max": [x + 0.3, y + 0.3] },
            "velocity": [speed, 0]
        })
    };
    let scene = json!({
        "dimensions": 2,
        "domain": { "min": [0, 0], "max": [WIDTH, 1.5], "sides": { "x_min": sides, "x_max": sides } },
        "gravity": [0, 0],
        "fluid": { "solver": "wcsph", "spacing": 0.05, "max_speed": 5, "viscosity": 1 },
        "neighbors": { "skin": skin },
        "bodies": [jet(0.4, 0.6, 4.0), jet(1.3, 0.95, -4.0), jet(0.1, 0.0, 3.0)],
        "time": { "duration": 0.12, "fps": 8.4 }
    });
    load::parse(&scene.to_string(), "jets.json", Path::new("."), &[])
        .unwrap_or_else(|error| panic!("{error}"))
}

/// Where particles and how fast they are at the end of a frame, by their number, and how often they were searched in how many
/// steps.
fn after_a_frame(scene: &Scene) -> (Vec<(Vec3, Vec3)>, [u64; 2]) {
    let mut simulation = common::simulate(scene, &Wanted::default());
    let frames = common::frames(&mut simulation, 1);
    let found = simulation.particles().expect("particles");
    let states = found.position.iter().copied().zip(found.velocity.iter().copied());
    (states.collect(), [u64::from(frames[1].searches), frames[1].steps])
}

/// The greatest difference of velocities, m/s.
fn difference(a: &[(Vec3, Vec3)], b: &[(Vec3, Vec3)]) -> f32 {
    assert_eq!(a.len(), b.len());
    let differences = a.iter().zip(b).map(|(a, b)| a.1.distance(b.1));
    differences.fold(0.0, f32::max)
}

#[test]
fn jets_that_pass_within_the_life_of_a_list_find_each_other() {
    let (searched, _) = after_a_frame(&jets("particles", 0.0, 0.0));
    let unhurried = |v: &Vec3| (3.0 - v.x.abs()).abs() < 0.01 || (4.0 - v.x.abs()).abs() < 0.01;
    assert!(!searched.iter().all(|(_, v)| unhurried(v)), "they have met");
    let (listed, [searches, steps]) = after_a_frame(&jets("particles", 0.0, 0.1));
    // A list that expected particles to stay would serve two steps: half a skin is 8 mm, and a jet goes 4 mm in each.
    assert!(3 * searches < steps, "{searches} searches in {steps} steps");
    let off = difference(&searched, &listed);
    assert!(off < 1e-4, "{off} m/s");
}

#[test]
fn it_does_not_matter_where_space_repeats() {
    let (inside, _) = after_a_frame(&jets("periodic", 0.0, 0.1));
    let (across, [searches, steps]) = after_a_frame(&jets("periodic", 1.2, 0.1));
    assert!(3 * searches < steps, "{searches} searches in {steps} steps");
    let off = difference(&inside, &across);
    assert!(off < 1e-4, "{off} m/s");
}
