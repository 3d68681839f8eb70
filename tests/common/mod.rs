//! What several test programs need.

use std::path::Path;

use sliceflow::scene::Scene;
use sliceflow::scene::load;

/// A small scene that has a bit of everything, in two or three dimensions, with overrides.
pub fn scene(dimensions: usize, overrides: &[&str]) -> Scene {
    let text = match dimensions {
        2 => include_str!("scene_2d.json"),
        _ => include_str!("scene_3d.json"),
    };
    let overrides: Vec<String> = overrides.iter().map(|&o| o.to_owned()).collect();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/common");
    match load::parse(text, "test.json", &folder, &overrides) {
        Ok(scene) => scene,
        Err(error) => panic!("{error}"),
    }
}
