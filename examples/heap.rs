//! Sliceflow as a library: a scene from text is simulated, and its figures are read frame by frame.

use std::path::Path;

use sliceflow::error::Result;
use sliceflow::gpu::{AdapterChoice, Gpu};
use sliceflow::plan::{Plan, Wanted};
use sliceflow::scene::{column, load};
use sliceflow::simulation::Simulation;
use sliceflow::simulation::frame::{Frame, Values};

const SCENE: &str = r#"{
  "dimensions": 2,
  "domain": { "min": [-0.5, 0], "max": [0.5, 0.7] },
  "grains": { "radius": 0.006, "density": 2500, "spring": 4e5, "restitution": 0.5, "shear": 40 },
  "bodies": [{ "shape": { "kind": "box", "min": [-0.1, 0], "max": [0.1, 0.5] }, "jitter": 0.02, "spacing": 0.0125 }],
  "time": { "duration": 1, "fps": 10 }
}"#;

fn main() -> Result<()> {
    // Text becomes a checked scene. Paths of meshes would start from this folder; the list could change keys.
    let scene = load::parse(SCENE, "heap.json", Path::new("."), &[])?;
    // A plan lists every buffer and pass. Nobody wants pictures here, so there are none.
    let gpu = Gpu::open(&AdapterChoice::Best, false)?;
    let wanted = Wanted {
        statistics: true,
        columns: column::find("y").into_iter().collect(),
        ..Wanted::default()
    };
    let plan = Plan::new(&scene, &gpu.limits, &wanted)?;
    let mut simulation = Simulation::new(gpu, &scene, &plan)?;
    // Frames come back a little later than they are asked for, so that the device never waits.
    for _ in 0..scene.time.frames {
        if let Some(frame) = simulation.next_frame()? {
            report(&frame);
        }
    }
    while let Some(frame) = simulation.finish_frame()? {
        report(&frame);
    }
    Ok(())
}

fn report(frame: &Frame) {
    let top = frame.columns.iter().find_map(|column| match &column.values {
        Values::Float(heights) => heights.iter().copied().reduce(f32::max),
        _ => None,
    });
    let energy = frame.statistics.map_or(0.0, |figures| figures.kinetic_energy);
    println!(
        "t = {:.1} s: {} grains, the highest at {:.3} m, {energy:.4} J",
        frame.time,
        frame.particles,
        top.unwrap_or_default()
    );
}
