//! All pairs of bare points, and the command that finds them in files.

use std::fs;
use std::path::{Path, PathBuf};

use assert_cmd::{Command, cargo_bin_cmd};
use glam::DVec3;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::Value;
use sliceflow::gpu::device::Limits;

use sliceflow::neighbors::STORAGES;
use sliceflow::output::npy;
use sliceflow::plan::{Plan, Wanted};
use sliceflow::scene::model::Addressing;
use sliceflow::scene::npy::Array;
use sliceflow::scene::{Dimensions, Neighbors, Scene};
use sliceflow::simulation::Simulation;

use crate::common;

/// Points of a cloud of width 1 around `center`, on multiples of 2⁻²⁰, which f64 holds around a million too.
fn cloud(count: usize, dimensions: Dimensions, center: f64) -> Vec<DVec3> {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut coordinate = || f64::from(rng.random_range(0..1 << 20)) / f64::from(1 << 20) - 0.5 + center;
    let mut point = || DVec3::new(coordinate(), coordinate(), coordinate());
    let flat = |p: DVec3| match dimensions {
        Dimensions::Two => p.with_z(0.0),
        Dimensions::Three => p,
    };
    (0..count).map(|_| flat(point())).collect()
}

/// For each point the places of those nearer than the radius, in f64.
fn brute_force(points: &[DVec3], radius: f64) -> Vec<Vec<u32>> {
    let near = |a: &DVec3| {
        let within = |b: &DVec3| (*b - *a).length_squared() < radius * radius;
        let found = points.iter().enumerate().filter(|(_, b)| within(b));
        found
            .filter(|(_, b)| !std::ptr::eq(*b, a))
            .map(|(j, _)| j as u32)
            .collect()
    };
    points.iter().map(near).collect()
}

#[test]
fn bare_points_are_a_scene_that_every_grid_searches() {
    for (dimensions, radius) in [(Dimensions::Two, 0.06), (Dimensions::Three, 0.13)] {
        let points = cloud(800, dimensions, 1e6);
        let expected = brute_force(&points, radius);
        for (addressing, storage) in common::grids_in_turn(dimensions.count()) {
            let neighbors = Neighbors {
                addressing: addressing.kind,
                storage: storage.kind,
                slots: 32,
                ..Default::default()
            };
            let scene = Scene::of_points(&points, dimensions, radius, neighbors).unwrap();
            let mut simulation = common::simulate(&scene, &Wanted::default());
            simulation.next_frame().unwrap();
            let found = simulation.neighbor_lists().unwrap();
            for (i, ids) in expected.iter().enumerate() {
                let list = &found.ids[found.start[i] as usize..found.start[i + 1] as usize];
                let grid = (addressing.name, storage.name);
                assert_eq!(list, ids, "{grid:?}, {dimensions:?}: point {i}");
            }
        }
    }
}

#[test]
fn a_radius_too_small_for_the_whole_box_is_refused_with_a_mend_and_searched_by_a_sparse_grid() {
    let points = cloud(100, Dimensions::Three, 0.0);
    let plan = |addressing| {
        let neighbors = Neighbors {
            addressing,
            ..Default::default()
        };
        let scene = Scene::of_points(&points, Dimensions::Three, 1e-4, neighbors).unwrap();
        Plan::new(&scene, &Limits::PROMISED, &Wanted::default())
    };
    let message = plan(Addressing::Uniform).unwrap_err().to_string();
    for part in ["voxels would fit", "search radius"] {
        assert!(message.contains(part), "{message}");
    }
    assert!(plan(Addressing::Hash).is_ok());
}

#[test]
fn lists_made_in_many_parts_are_the_same() {
    let points = cloud(1500, Dimensions::Three, 0.0);
    let radius = 0.13;
    for storage in STORAGES {
        let neighbors = Neighbors {
            storage: storage.kind,
            slots: 32,
            ..Default::default()
        };
        let scene = Scene::of_points(&points, Dimensions::Three, radius, neighbors).unwrap();
        let mut gpu = common::gpu();
        let plan = Plan::new(&scene, &gpu.limits, &Wanted::default()).unwrap();
        let expected = brute_force(&points, radius);
        let most = expected.iter().map(Vec::len).max().unwrap();
        // Room for the longest list and nothing more: several hundred parts.
        gpu.limits.binding = 4 * most as u64;
        let mut simulation = Simulation::new(gpu, &scene, &plan).unwrap();
        simulation.next_frame().unwrap();
        let found = simulation.neighbor_lists().unwrap();
        assert_eq!(found.ids, expected.concat(), "{}", storage.name);

        let mut gpu = common::gpu();
        gpu.limits.binding = 4 * (most as u64 - 1);
        let mut simulation = Simulation::new(gpu, &scene, &plan).unwrap();
        simulation.next_frame().unwrap();
        let message = simulation.neighbor_lists().unwrap_err().to_string();
        assert!(message.contains(&format!("has {most} neighbors")), "{message}");
    }
}

fn sliceflow(args: &[&str]) -> Command {
    let mut command = cargo_bin_cmd!("sliceflow");
    command.arg("neighbors").args(args);
    command
}

/// Standard error of a command that fails with status 2.
fn failure(args: &[&str]) -> String {
    let assert = sliceflow(args).assert().code(2);
    String::from_utf8(assert.get_output().stderr.clone()).unwrap()
}

/// Numbers of a file, whose type is `kind`.
fn array(path: &Path, kind: &str) -> Vec<u64> {
    let bytes = fs::read(path).unwrap();
    let array = Array::parse(&bytes).unwrap();
    assert_eq!(array.kind, kind);
    array
        .numbers()
        .unwrap()
        .iter()
        .map(|&number| number as u64)
        .collect()
}

/// What the command finds in a file: its JSON, counts and lists.
fn found(file: &Path, radius: f64, more: &[&str]) -> (Value, Vec<u32>, Vec<Vec<u32>>) {
    let folder = tempfile::tempdir().unwrap();
    let text = |path: &Path| path.to_str().unwrap().to_owned();
    let counts = folder.path().join("counts.npy");
    let prefix = folder.path().join("pairs");
    let radius = radius.to_string();
    let (counts_text, prefix_text) = (text(&counts), text(&prefix));
    let file = text(file);
    let args = [
        "--json",
        &file,
        "--radius",
        &radius,
        "--counts",
        &counts_text,
        "--lists",
        &prefix_text,
    ];
    let args = [&args[..], more].concat();
    let assert = sliceflow(&args).assert().success();
    let report: Value = serde_json::from_slice(&assert.get_output().stdout).unwrap();
    let narrow = |numbers: Vec<u64>| {
        numbers
            .into_iter()
            .map(|number| number as u32)
            .collect::<Vec<_>>()
    };
    let counts = narrow(array(&counts, "<u4"));
    let offsets = array(&folder.path().join("pairs_offsets.npy"), "<u8");
    let ids = narrow(array(&folder.path().join("pairs_ids.npy"), "<u4"));
    let lists = offsets
        .windows(2)
        .map(|pair| ids[pair[0] as usize..pair[1] as usize].to_vec())
        .collect();
    (report, counts, lists)
}

/// The cloud in every format, with columns that are passed over and out of order where the format has names.
fn write_formats(folder: &Path, points: &[DVec3], axes: usize) -> Vec<PathBuf> {
    let path = |name: &str| folder.join(name);
    let mut numbers = Vec::new();
    let (mut named, mut bare) = (
        ["speed,y,x", "speed,y,x,z"][axes - 2].to_owned() + "\n",
        String::new(),
    );
    let z_property = ["", "property float z\n"][axes - 2];
    let header = |encoding: &str| {
        format!(
            "ply\nformat {encoding} 1.0\nelement vertex {}\nproperty float y\nproperty double x\nproperty int id\n\
             {z_property}end_header\n",
            points.len()
        )
    };
    let (mut ascii, mut binary) = (header("ascii"), header("binary_little_endian").into_bytes());
    for p in points {
        let row = &p.to_array()[..axes];
        numbers.extend_from_slice(row);
        let z = |separator| row.get(2).map_or(String::new(), |z| format!("{separator}{z}"));
        named += &format!("fast,{},{}{}\n", p.y, p.x, z(","));
        bare += &format!("{},{}{}\n", p.x, p.y, z(","));
        ascii += &format!("{} {} 7{}\n", p.y, p.x, z(" "));
        binary.extend((p.y as f32).to_le_bytes());
        binary.extend(p.x.to_le_bytes());
        binary.extend(7i32.to_le_bytes());
        if axes == 3 {
            binary.extend((p.z as f32).to_le_bytes());
        }
    }
    fs::write(path("named.csv"), named).unwrap();
    fs::write(path("bare.csv"), bare).unwrap();
    fs::write(path("ascii.ply"), ascii).unwrap();
    fs::write(path("binary.ply"), binary).unwrap();
    let singles: Vec<f32> = numbers.iter().map(|&x| x as f32).collect();
    npy::write(&path("single.npy"), axes, &singles).unwrap();
    let header = format!(
        "{{'descr': '<f8', 'fortran_order': True, 'shape': ({}, {axes}), }}\n",
        points.len()
    );
    let mut fortran = b"\x93NUMPY\x01\x00".to_vec();
    fortran.extend((header.len() as u16).to_le_bytes());
    fortran.extend(header.as_bytes());
    for axis in 0..axes {
        fortran.extend(points.iter().flat_map(|p| p[axis].to_le_bytes()));
    }
    fs::write(path("fortran.npy"), fortran).unwrap();
    [
        "named.csv",
        "bare.csv",
        "ascii.ply",
        "binary.ply",
        "single.npy",
        "fortran.npy",
    ]
    .map(path)
    .to_vec()
}

#[test]
fn every_format_gives_the_pairs_of_brute_force() {
    let folder = tempfile::tempdir().unwrap();
    for (dimensions, radius) in [(Dimensions::Two, 0.05), (Dimensions::Three, 0.15)] {
        let points = cloud(500, dimensions, 0.0);
        let expected = brute_force(&points, radius);
        let pairs = expected.concat().len() / 2;
        for file in write_formats(folder.path(), &points, dimensions.count()) {
            let (report, counts, lists) = found(&file, radius, &[]);
            let name = file.display();
            assert_eq!(lists, expected, "{name}, {dimensions:?}");
            assert!(
                counts
                    .iter()
                    .zip(&lists)
                    .all(|(&count, list)| count as usize == list.len())
            );
            assert_eq!(report["points"], 500, "{name}");
            assert_eq!(report["dimensions"], dimensions.count(), "{name}");
            assert_eq!(report["pairs"], pairs, "{name}");
        }
    }
}

#[test]
fn far_from_zero_nothing_is_lost() {
    let folder = tempfile::tempdir().unwrap();
    let points = cloud(500, Dimensions::Three, 1e6);
    let file = folder.path().join("far.npy");
    let numbers: Vec<f64> = points.iter().flat_map(|p| p.to_array()).collect();
    npy::write(&file, 3, &numbers).unwrap();
    let (report, _, lists) = found(&file, 0.15, &["--grid", "uniform-counting", "--repeat", "2"]);
    assert_eq!(lists, brute_force(&points, 0.15));
    assert_eq!(report["grid"], "uniform-counting");
    assert_eq!(report["notes"], serde_json::json!([]));
}

#[test]
fn one_point_is_alone_and_none_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("few.csv");
    fs::write(&file, "3,4,5\n").unwrap();
    let (report, counts, lists) = found(&file, 1.0, &[]);
    assert_eq!((counts, lists), (vec![0], vec![vec![]]));
    assert_eq!(report["neighbors_max"], 0);
    fs::write(&file, "x,y,z\n").unwrap();
    let message = failure(&["--radius", "1", file.to_str().unwrap()]);
    assert!(message.contains("no particles in it"), "{message}");
}

#[test]
fn a_pool_that_overflows_is_refused_unless_allowed() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("heap.csv");
    let heap: String = (0..11).map(|i| format!("0,{i}e-3\n")).collect();
    fs::write(&file, heap + "5,5\n").unwrap();
    let message = failure(&["--radius", "1", "--grid", "sliced-pool", file.to_str().unwrap()]);
    for part in ["7 of 12 points", "--slots", "--allow-overflow"] {
        assert!(message.contains(part), "{message}");
    }
    let (report, counts, _) = found(&file, 1.0, &["--grid", "sliced-pool", "--allow-overflow"]);
    assert_eq!((&report["overflow"], &report["pairs"]), (&7.into(), &Value::Null));
    assert_eq!(counts[0], 3);
    let (report, counts, _) = found(&file, 1.0, &["--grid", "sliced-pool", "--slots", "11"]);
    assert_eq!((&report["overflow"], &report["pairs"]), (&0.into(), &55.into()));
    assert_eq!(counts, [[10; 11].as_slice(), &[0]].concat());
}

#[test]
fn files_that_exist_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let text = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (file, counts, lists) = (text("two.csv"), text("counts.npy"), text("pairs"));
    fs::write(&file, "0,0\n0,1\n").unwrap();
    fs::write(&counts, "mine").unwrap();
    fs::write(text("pairs_ids.npy"), "mine too").unwrap();
    for output in [["--counts", &counts], ["--lists", &lists]] {
        let message = failure(&[&[&*file, "--radius", "2"], &output[..]].concat());
        assert!(
            message.contains("exists") && message.contains("--force"),
            "{message}"
        );
    }
    assert_eq!(fs::read(&counts).unwrap(), b"mine");
    assert_eq!(fs::read(text("pairs_ids.npy")).unwrap(), b"mine too");
    assert!(!Path::new(&text("pairs_offsets.npy")).exists());
    sliceflow(&[&file, "--radius", "2", "--counts", &counts, "--force"])
        .assert()
        .success();
    assert_eq!(array(Path::new(&counts), "<u4"), [1, 1]);
}

#[test]
fn mistakes_are_reported_with_place_and_help() {
    let folder = tempfile::tempdir().unwrap();
    let text = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (good, broken) = (text("good.csv"), text("broken.csv"));
    fs::write(&good, "0,0\n0,1\n").unwrap();
    fs::write(&broken, "x,y\n0,0\n0,nan\n").unwrap();
    let nowhere = text("nowhere/counts.npy");
    for (args, expected) in [
        (vec![&*broken, "--radius", "1"], "broken.csv: line 3: y is NaN"),
        (vec![&*good, "--radius", "0"], "radius is 0"),
        (vec![&*good, "--radius=-1"], "radius is -1"),
        (vec![&*good, "--radius", "inf"], "radius is inf"),
        (vec![&*good, "--radius", "1", "--dimensions", "3"], "z is missing"),
        (vec![&*good, "--radius", "1", "--grid", "sliced"], "is not a grid"),
        (
            vec![&*good, "--radius", "1", "--grid", "sliced-pol"],
            "there is counting, pool",
        ),
        (
            vec![&*good, "--radius", "1", "--counts", "counts.csv"],
            "end in .npy",
        ),
        (vec![&*good, "--radius", "1", "--counts", &nowhere], "no folder"),
        (
            vec![&*good, "--radius", "1", "--lists", "pairs.npy"],
            "pairs_offsets.npy",
        ),
        (
            vec![&*good, "--radius", "1", "--lists", "a", "--counts", "a_ids.npy"],
            "written twice",
        ),
    ] {
        let message = failure(&args);
        assert!(message.contains(expected), "{args:?}: {message}");
    }
}
