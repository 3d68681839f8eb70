//! Where voxels are and how full, as sinks see it.

use sliceflow::neighbors::Grid;
use sliceflow::plan::Wanted;
use sliceflow::scene::model::Axis;
use sliceflow::scene::{Scene, column};
use sliceflow::simulation::{Frame, Values};

use crate::common;

/// Room for one texel a voxel in the test scenes.
const SIDE: u32 = 128;

fn observe(dimensions: usize, addressing: &str, storage: &str, axis: &str) -> (Frame, Scene) {
    let scene = common::scene(
        dimensions,
        &[
            &format!("neighbors.addressing={addressing}"),
            &format!("neighbors.storage={storage}"),
            &format!("neighbors.slicing_axis={axis}"),
            "neighbors.slots=32",
            "neighbors.skin=0",
            "time.fps=2000",
        ],
    );
    let wanted = Wanted {
        statistics: true,
        columns: column::VECTORS[..1].to_vec(),
        voxel_map: Some(SIDE),
        ..Default::default()
    };
    let mut simulation = common::simulate(&scene, &wanted);
    simulation.next_frame().unwrap();
    simulation.next_frame().unwrap();
    simulation.finish_frame().unwrap();
    let frame = simulation.finish_frame().unwrap().unwrap();
    (frame, scene)
}

#[test]
fn every_particle_is_in_a_box_and_in_the_map() {
    for dimensions in [2, 3] {
        for ((addressing, storage), axis) in common::grids_and_axes(dimensions) {
            let (addressing, storage) = (addressing.name, storage.name);
            let what = format!("{addressing}-{storage} across {axis} in {dimensions}D");
            let (frame, scene) = observe(dimensions, addressing, storage, axis);
            check(&frame, &scene, &what);
        }
    }
}

fn check(frame: &Frame, scene: &Scene, what: &str) {
    let side = Grid::new(scene, Axis::Y).side;
    let dimensions = scene.dimensions.count();
    let voxels = frame.voxels.as_ref().unwrap();
    let Values::Double { values, .. } = &frame.columns[0].values else {
        panic!("positions are doubles")
    };
    for position in values.chunks(dimensions) {
        let inside = voxels.boxes.iter().any(|[low, high]| {
            (0..dimensions).all(|k| {
                // Boxes are in local coordinates, positions in the scene's.
                let x = (position[k] - scene.origin[k]) as f32;
                low[k] - 0.01 * side <= x && x <= high[k] + 0.01 * side
            })
        });
        assert!(
            inside || voxels.boxes.is_empty(),
            "{what}: {position:?} is in no box"
        );
    }
    let statistics = frame.statistics.unwrap();
    let has_rows = ["rows", "bitmap"].iter().any(|rows| what.starts_with(rows));
    assert_eq!(voxels.boxes.is_empty(), has_rows, "{what}");
    if voxels.boxes.len() > 1 {
        let volume = |[low, high]: &[glam::Vec3; 2]| -> f32 {
            (0..dimensions).map(|k| (high[k] - low[k]) / side).product()
        };
        let boxed: f32 = voxels.boxes.iter().map(volume).sum();
        assert_eq!(boxed.round() as u32, statistics.voxels_allocated, "{what}");
    }
    let counts: Vec<u32> = voxels.map.iter().flatten().copied().collect();
    // A voxel is a square of so many texels a side.
    let scale = SIDE / f64::from(statistics.voxels_allocated).sqrt().ceil() as u32;
    assert!(scale > 0, "{what}");
    assert_eq!(
        counts.len() as u32,
        statistics.voxels_allocated * scale * scale,
        "{what}"
    );
    assert_eq!(
        counts.iter().sum::<u32>(),
        frame.particles * scale * scale,
        "{what}"
    );
}
