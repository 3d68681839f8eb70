//! Particles of a fluid that stand in one place, or nearly so, come apart.

use glam::Vec3;
use sliceflow::plan::Wanted;
use sliceflow::scene::{Scene, load};

use crate::common;

/// A block of fluid on the floor in which particle 29 stands where particle 28 is, but for so many spacings; and the spacing.
fn nearly(dimensions: usize, solver: &str, aside: f32) -> (Scene, f32) {
    let corner = |low: &str, high: &str| match dimensions {
        2 => (format!("[{low},0]"), format!("[{high},1]")),
        _ => (format!("[{low},0,{low}]"), format!("[{high},0.5,{high}]")),
    };
    let (low, high) = corner("0.2", "0.8");
    let (first, last) = match dimensions {
        2 => ("[0.3,0]", "[0.7501,0.4001]"),
        _ => ("[0.3,0,0.3]", "[0.6001,0.3001,0.6001]"),
    };
    let gravity = if dimensions == 2 { "[0,-10]" } else { "[0,-10,0]" };
    let text = format!(
        r#"{{ "dimensions": {dimensions}, "domain": {{ "min": {low}, "max": {high} }}, "gravity": {gravity},
            "fluid": {{ {solver}, "spacing": 0.05, "max_speed": 1 }},
            "bodies": [{{ "shape": {{ "kind": "box", "min": {first}, "max": {last} }} }}],
            "time": {{ "duration": 1, "fps": 50 }} }}"#
    );
    let mut scene = load::parse(&text, "test.json", std::path::Path::new("."), &[])
        .unwrap_or_else(|error| panic!("{error}"));
    let spacing = scene.fluid().expect("a fluid").spacing as f32;
    scene.particles.position[29] = scene.particles.position[28] + Vec3::new(aside * spacing, 0.0, 0.0);
    (scene, spacing)
}

/// From particle 28 to 29 after so many frames, in spacings.
fn between((scene, spacing): &(Scene, f32), frames: u32) -> Vec3 {
    let mut simulation = common::simulate(scene, &Wanted::default());
    common::frames(&mut simulation, frames);
    let position = simulation.particles().expect("particles").position;
    (position[29] - position[28]) / spacing
}

#[test]
fn they_come_apart_in_every_solver() {
    let mut together = Vec::new();
    for dimensions in [2, 3] {
        for solver in [
            r#""solver": "sph""#,
            r#""solver": "wcsph", "density_from": "summation""#,
            r#""solver": "wcsph", "density_from": "continuity""#,
            r#""solver": "dfsph""#,
        ] {
            for aside in [0.0, 1e-7].into_iter().take(4 - dimensions) {
                let way = between(&nearly(dimensions, solver, aside), 8);
                println!("{dimensions}D, {solver}, {aside:e}: {} spacings", way.length());
                if way.length() < 0.2 {
                    together.push(format!("{dimensions}D, {solver}, {aside:e}: {way}"));
                }
            }
        }
    }
    assert!(together.is_empty(), "{}", together.join("\n"));
}
