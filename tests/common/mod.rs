//! What several test programs need.

use std::path::Path;

use sliceflow::gpu::{AdapterChoice, Gpu};
use sliceflow::plan::{Plan, Wanted};
use sliceflow::scene::Scene;
use sliceflow::scene::load;
use sliceflow::simulation::Simulation;

/// A small scene that has a bit of everything, in two or three dimensions, with overrides.
#[allow(dead_code)]
pub fn scene(dimensions: usize, overrides: &[&str]) -> Scene {
    let text = match dimensions {
        2 => include_str!("scene_2d.json"),
        _ => include_str!("scene_3d.json"),
    };
    parsed(text, overrides)
}

/// A small tank of fluid with an obstacle that moves.
#[allow(dead_code)]
pub fn fluid(dimensions: usize, overrides: &[&str]) -> Scene {
    let text = match dimensions {
        2 => include_str!("fluid_2d.json"),
        _ => include_str!("fluid_3d.json"),
    };
    parsed(text, overrides)
}

#[allow(dead_code)]
fn parsed(text: &str, overrides: &[&str]) -> Scene {
    let overrides: Vec<String> = overrides.iter().map(|&o| o.to_owned()).collect();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/common");
    match load::parse(text, "test.json", &folder, &overrides) {
        Ok(scene) => scene,
        Err(error) => panic!("{error}"),
    }
}

/// A simulation of a scene on the test adapter, with all checks in the shaders.
#[allow(dead_code)]
pub fn simulate(scene: &Scene, wanted: &Wanted) -> Simulation {
    let gpu = Gpu::open(&AdapterChoice::Best, true).expect("tests need an adapter; software Vulkan will do");
    let plan = Plan::new(scene, &gpu.limits, wanted).expect("a plan");
    Simulation::new(gpu, scene, &plan).expect("a simulation")
}
