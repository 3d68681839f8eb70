//! Grids that follow their particles beyond the domain and grow on the device.

use glam::Vec3;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sliceflow::neighbors::first_grid;
use sliceflow::plan::Wanted;
use sliceflow::scene::Scene;
use sliceflow::scene::model::SlicingAxis;
use sliceflow::simulation::{Frame, Values};

use crate::common;

const FOLLOWING: [&str; 3] = ["sliced", "rows", "bitmap"];

fn frames(scene: &Scene, last: u32) -> Vec<Frame> {
    let columns = sliceflow::output::columns_named(["position"]).expect("a column");
    let wanted = Wanted {
        statistics: true,
        columns,
        ..Default::default()
    };
    common::frames(&mut common::simulate(scene, &wanted), last)
}

fn positions(frame: &Frame) -> &[f64] {
    match &frame.columns[0].values {
        Values::Double { values, .. } => values,
        other => panic!("positions are doubles, not {other:?}"),
    }
}

#[test]
fn a_grid_that_grows_loses_nothing_and_changes_no_bit() {
    for dimensions in [2, 3] {
        let (position, velocity) = common::burst(dimensions, 1200);
        // So that no grain moves farther than its neighbors are in a step.
        let velocity: Vec<Vec3> = velocity.iter().map(|&v| 0.7 * v).collect();
        for addressing in FOLLOWING {
            // In 2D, one way to keep particles is enough.
            let kept = if dimensions == 2 { 1 } else { usize::MAX };
            let grids = common::grids_by_query().into_iter();
            for (_, storage) in grids.filter(|grid| grid.0.name == addressing).take(kept) {
                let choices = |margin: &str| {
                    [
                        format!("neighbors.addressing={addressing}"),
                        format!("neighbors.storage={}", storage.name),
                        "neighbors.slots=16".into(),
                        format!("neighbors.margin={margin}"),
                        "time.fps=60".into(),
                    ]
                };
                let run = |margin: &str| {
                    let choices = choices(margin);
                    let choices: Vec<&str> = choices.iter().map(String::as_str).collect();
                    frames(
                        &common::open_scene(dimensions, &choices, position.clone(), velocity.clone()),
                        3,
                    )
                };
                let (tight, roomy) = (run("1"), run("100"));
                let label = format!("{dimensions}D {addressing} × {}", storage.name);
                let grown: u32 = tight.iter().map(|frame| frame.reallocations).sum();
                assert!(grown > 0, "{label}: nothing had to grow");
                for (a, b) in tight.iter().zip(&roomy) {
                    assert_eq!(a.steps, b.steps, "{label}");
                    assert_eq!(positions(a), positions(b), "{label}, frame {}", a.index);
                    assert_eq!(a.statistics, b.statistics, "{label}, frame {}", a.index);
                }
            }
        }
    }
}

#[test]
fn what_is_too_far_is_counted_and_does_not_take_memory() {
    let (mut position, mut velocity) = common::burst(3, 500);
    velocity.fill(Vec3::ZERO);
    let side = common::scene(3, &[]).domain.max.x * 2.0;
    position.push(Vec3::new(1e3 * side, 0.0, 0.0));
    position.push(Vec3::new(0.0, -1e3 * side, 0.0));
    velocity.resize(position.len(), Vec3::ZERO);
    // In the other two, border voxels take what is beyond.
    let bounded = ["uniform", "morton"];
    let grids = common::grids_in_turn(0).into_iter();
    for (addressing, storage) in grids.filter(|grid| !bounded.contains(&grid.0.name)) {
        let choices = [
            format!("neighbors.addressing={}", addressing.name),
            format!("neighbors.storage={}", storage.name),
        ];
        let choices: Vec<&str> = choices.iter().map(String::as_str).collect();
        let scene = common::open_scene(3, &choices, position.clone(), velocity.clone());
        let frames = frames(&scene.with_steps_per_frame(4), 1);
        let label = format!("{} × {}", addressing.name, storage.name);
        assert_eq!(frames[0].quarantined, 2, "{label}");
        assert_eq!(frames[1].quarantined, 2, "{label}");
        assert_eq!(frames[0].reallocations, 0, "{label}");
    }
}

#[test]
fn one_stray_particle_costs_memory_by_its_distance_in_its_slice_only() {
    let (mut position, velocity) = common::burst(3, 500);
    let base = common::scene(3, &[]);
    let stray = Vec3::new(3.0 * base.domain.max.x, 0.0, 0.0);
    let voxels = |addressing: &str, position: &[Vec3]| {
        let choice = format!("neighbors.addressing={addressing}");
        let scene = common::open_scene(
            3,
            &[&choice, "neighbors.margin=1"],
            position.to_vec(),
            vec![Vec3::ZERO; position.len()],
        );
        sliceflow::neighbors::room_for(&scene, sliceflow::scene::model::Axis::Y, position)
    };
    let before = FOLLOWING.map(|addressing| voxels(addressing, &position));
    position.push(stray);
    assert_eq!(position.len(), velocity.len() + 1);
    let after = FOLLOWING.map(|addressing| voxels(addressing, &position));
    let more = |k: usize| after[k].voxels - before[k].voxels;
    let distance = (stray.x / (2.0 * base.radius() as f32)) as u32;
    assert!(
        more(0) > distance,
        "a slice gets as wide as the distance: {}",
        more(0)
    );
    assert!(
        more(1) <= distance + 8,
        "a row gets as long as the distance: {}",
        more(1)
    );
    assert_eq!(more(2), 1, "the bitmap has one voxel more");
    assert!(
        after[2].words - before[2].words <= distance / 32 + 1,
        "and a bit for each voxel between"
    );
}

#[test]
fn auto_slices_across_the_axis_with_the_fewest_voxels_and_turns_when_it_grows() {
    // A plate across x needs one slice when cut across x. It flies apart along x and z.
    let base = common::scene(3, &[]);
    let reach = 2.0 * base.radius() as f32;
    let mut position = Vec::new();
    let mut velocity = Vec::new();
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    for i in 0..30 {
        for j in 0..30 {
            let at = Vec3::new((i + j) as f32 * 0.6, i as f32 - 15.0, j as f32 - 15.0);
            position.push(at * reach);
            velocity.push(40.0 * Vec3::new(0.0, 0.0, rng.random::<f32>() - 0.5));
        }
    }
    for axis in ["x", "y", "z", "auto"] {
        let choice = format!("neighbors.slicing_axis={axis}");
        let scene = common::open_scene(
            3,
            &[&choice, "neighbors.margin=1", "time.fps=60"],
            position.clone(),
            velocity.clone(),
        );
        let grid = first_grid(&scene);
        if axis == "auto" {
            assert_eq!(scene.neighbors.slicing_axis, SlicingAxis::Auto);
            let fixed = ["x", "y", "z"].map(|axis| {
                let choice = format!("neighbors.slicing_axis={axis}");
                first_grid(&common::open_scene(
                    3,
                    &[&choice, "neighbors.margin=1"],
                    position.clone(),
                    velocity.clone(),
                ))
            });
            let least = fixed.iter().min_by_key(|grid| grid.capacity).unwrap();
            assert_eq!(grid.capacity, least.capacity);
            assert_eq!(grid.axis, least.axis);
        }
        let frames = frames(&scene, 3);
        assert!(
            frames.iter().map(|frame| frame.reallocations).sum::<u32>() > 0,
            "{axis}"
        );
    }
}

/// The farthest that any coordinate of two frames lies apart.
fn apart(a: &Frame, b: &Frame) -> f64 {
    let pairs = positions(a).iter().zip(positions(b));
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn lists_serve_several_steps_and_miss_no_contact() {
    for (dimensions, integrator) in [(2, "velocity_verlet"), (3, "symplectic_euler")] {
        // The heap of the test scene, thrown against its walls.
        let run = |skin: &str, grid: &str| {
            let choices = [
                format!("neighbors.skin={skin}"),
                format!("neighbors.addressing={grid}"),
                format!("time.integrator={integrator}"),
            ];
            let choices: Vec<&str> = choices.iter().map(String::as_str).collect();
            let scene = common::scene(dimensions, &choices);
            (frames(&scene, 2), scene)
        };
        let (searched, scene) = run("0", "sliced");
        let moved = apart(&searched[0], &searched[2]);
        let diameter = 2.0 * scene.radius();
        assert!(moved > 0.5 * diameter, "nothing happens: {moved} m");
        for (grid, skin) in [
            ("uniform", "0.05"),
            ("sliced", "0.05"),
            ("bitmap", "0.4"),
            ("hash", "0.4"),
            ("sliced", "0.4"),
        ] {
            let (listed, _) = run(skin, grid);
            let error = apart(&searched[2], &listed[2]);
            assert!(
                error < 2e-3 * diameter,
                "{dimensions}D {integrator}, {grid}, skin {skin}: {error} m apart after {} steps",
                listed[2].steps
            );
        }
        let [one, two] = [run("0.4", "sliced"), run("0.4", "sliced")].map(|(frames, _)| frames);
        assert_eq!(positions(&one[2]), positions(&two[2]), "twice the same");
    }
}

#[test]
fn grains_that_meet_between_two_frames_are_found() {
    // Two grains far beyond each other's lists meet in the middle of a frame.
    let base = common::scene(3, &[]);
    let diameter = 2.0 * base.radius() as f32;
    let speed = 2.0 * diameter * base.time.fps as f32;
    let run = |skin: &str| {
        let at = |side: f32| Vec3::X * side;
        let position = vec![at(diameter), at(-diameter)];
        let velocity = vec![at(-speed), at(speed)];
        frames(
            &common::open_scene(3, &[&format!("neighbors.skin={skin}")], position, velocity),
            1,
        )
    };
    let (searched, listed) = (run("0"), run("0.1"));
    let right = positions(&searched[1])[0];
    assert!(right > 0.4 * f64::from(diameter), "they bounce: {right} m");
    let error = apart(&searched[1], &listed[1]);
    assert!(error < 1e-3 * f64::from(diameter), "{error} m apart");
    assert!(
        (2..listed[1].steps as u32 / 2).contains(&listed[1].searches),
        "{} searches",
        listed[1].searches
    );
}
