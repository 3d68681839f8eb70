//! What one does with runs afterwards: draw them again, and compare them.

#![cfg(unix)]

use std::collections::BTreeSet;
use std::fs;
use std::process::Command;

use serde_json::Value;

use crate::place::{FRAMES, Place};

fn pictures(place: &Place, run: &str) -> Vec<(String, Vec<u8>)> {
    let files = place.files(run).into_iter();
    files
        .filter(|(name, _)| name.starts_with("frame_") && name.ends_with(".png"))
        .collect()
}

#[test]
fn pictures_are_drawn_again_from_particle_files_to_the_byte() {
    let place = Place::new();
    let colored = ["--set", "render.color.by=contacts"];
    place.told(&mut place.run("run", &colored), 0);
    let told = place.told(&mut place.sliceflow(&["render", "run"]), 0);
    assert!(told.contains("drawing 25 frames"), "{told}");
    assert_eq!(pictures(&place, "run").len(), FRAMES as usize);
    assert!(
        pictures(&place, "run") == pictures(&place, "run_render"),
        "pictures differ"
    );
    assert_eq!(place.files("run_render").len(), FRAMES as usize);

    // Another color, size and view.
    let other = [
        "render",
        "run",
        "--set",
        "render.color.by=y",
        "--size",
        "200x100",
        "--out",
        "other",
    ];
    place.told(&mut place.sliceflow(&other), 0);
    let picture = image::open(place.path("other/frame_000024.png")).unwrap();
    assert_eq!((picture.width(), picture.height()), (200, 100));
    place.told(
        &mut place.run("speed", &["--set", "render.color.by=speed", "--frames", "3"]),
        0,
    );
    let again = [
        "render",
        "run",
        "--set",
        "render.color.by=speed",
        "--out",
        "again",
    ];
    place.told(&mut place.sliceflow(&again), 0);
    assert!(
        pictures(&place, "again")[..3] == pictures(&place, "speed")[..],
        "colors differ"
    );

    for (args, status, expected) in [
        (
            &["render", "run", "--out", "x", "--set", "gravity=[0,0]"][..],
            2,
            "`gravity`",
        ),
        (
            &[
                "render",
                "run",
                "--out",
                "x",
                "--set",
                "colliders[0].shape.radius=0.1",
            ],
            2,
            "`colliders`",
        ),
        (&["render", "run_render", "--out", "x"], 2, "was drawn from"),
        (&["resume", "run_render"], 2, "was drawn from"),
        (&["render", "run", "--out", "run"], 2, "--force"),
        (&["render", "nothing", "--out", "x"], 1, "nothing/run.json"),
    ] {
        let told = place.told(&mut place.sliceflow(args), status);
        assert!(told.contains(expected), "{args:?}: {told}");
        assert!(!place.path("x").exists(), "{args:?}");
    }
}

/// Runs of the same scene, each with particle files of one format and no checkpoints.
#[test]
fn every_format_is_compared_and_drawn() {
    let place = Place::new();
    let run = |out: &str, format: &str, more: &[&str]| {
        let args = [
            "run",
            "scene.json",
            "--out",
            out,
            "--particles",
            format,
            "--checkpoint-every",
            "0",
        ];
        place.told(&mut place.sliceflow(&[&args, more].concat()), 0);
    };
    let diff = |one: &str, two: &str| {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("sliceflow"));
        let output = command
            .current_dir(place.path(""))
            .args(["diff", one, two, "--json"])
            .output();
        serde_json::from_slice::<Value>(&output.unwrap().stdout).unwrap()
    };
    run("npy", "npy", &[]);
    run("other", "ply", &["--set", "events[0].set.gravity=[30,-9]"]);
    for format in ["ply", "vtk", "bgeo"] {
        run(format, format, &[]);
        let same = diff("npy", format);
        assert_eq!(same["particle_frames"], FRAMES, "{format}");
        assert_eq!(same["first"], Value::Null, "{format}");

        let found = diff(format, "other");
        assert_eq!(found["first"]["frame"], 11, "{format}");
        let growth = found["growth"].as_array().unwrap();
        let columns: BTreeSet<_> = growth.iter().map(|row| row["column"].as_str().unwrap()).collect();
        let expected = ["position", "velocity", "density", "pressure", "contacts"];
        assert!(
            columns.iter().all(|column| expected.contains(column)),
            "{format}: {columns:?}"
        );
        for column in ["position", "velocity", "density"] {
            assert!(columns.contains(column), "{format}: {columns:?}");
        }

        let told = place.told(&mut place.sliceflow(&["render", format]), 0);
        assert!(told.contains("drawing 25 frames"), "{format}: {told}");
        let again = format!("{format}_render");
        assert_eq!(pictures(&place, &again).len(), FRAMES as usize);
        // Single precision moves a coordinate by less than a pixel, and may tip one at an edge.
        assert!(
            format != "vtk" || pictures(&place, format) == pictures(&place, &again),
            "pictures differ"
        );
    }
    fs::write(place.path("ply/particles_000003.ply"), "ply\n").unwrap();
    let render = ["render", "ply", "--force", "--out", "ply_render"];
    let told = place.told(&mut place.sliceflow(&render), 2);
    assert!(
        told.contains("particles_000003.ply") && told.contains("remove it"),
        "{told}"
    );
}

#[test]
fn checkpoints_are_drawn_too_and_what_is_missing_is_told() {
    let place = Place::new();
    let args = [
        "run",
        "scene.json",
        "--out",
        "run",
        "--checkpoint-every",
        "5",
        "--keep-checkpoints",
        "9",
    ];
    place.told(&mut place.sliceflow(&args), 0);
    let told = place.told(&mut place.sliceflow(&["render", "run"]), 0);
    assert!(
        told.contains("drawing 5 frames") && told.contains("20 others"),
        "{told}"
    );
    let (before, after) = (place.files("run"), place.files("run_render"));
    assert_eq!(after.len(), 5);
    for (name, bytes) in &after {
        assert!(*bytes == before[name], "{name} differs");
    }

    place.told(
        &mut place.run("bare", &["--columns", "position,id", "--checkpoint-every", "0"]),
        0,
    );
    let told = place.told(&mut place.sliceflow(&["render", "bare"]), 2);
    assert!(
        told.contains("no velocity") && told.contains("render.color.by=y"),
        "{told}"
    );
    place.told(
        &mut place.sliceflow(&["render", "bare", "--set", "render.color.by=density"]),
        0,
    );
    let none = [
        "run",
        "scene.json",
        "--out",
        "none",
        "--frames",
        "2",
        "--checkpoint-every",
        "0",
    ];
    place.told(&mut place.sliceflow(&none), 0);
    let told = place.told(&mut place.sliceflow(&["render", "none"]), 2);
    assert!(told.contains("--particles vtk"), "{told}");
}

#[test]
fn runs_are_compared() {
    let place = Place::new();
    place.told(&mut place.run("one", &[]), 0);
    place.told(&mut place.run("two", &[]), 0);
    place.told(
        &mut place.run("other", &["--set", "events[0].set.gravity=[3.001,-9]"]),
        0,
    );
    let diff = |two: &str, status: i32, more: &[&str]| {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("sliceflow"));
        command
            .current_dir(place.path(""))
            .args(["diff", "one", two])
            .args(more);
        let output = command.output().unwrap();
        assert_eq!(
            output.status.code(),
            Some(status),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        String::from_utf8(output.stdout).unwrap()
    };
    let same = diff("two", 0, &[]);
    assert!(
        same.contains("particles: equal in 25 frames") && same.contains("pictures: equal in 25"),
        "{same}"
    );
    let text = diff("other", 1, &[]);
    // Gravity changes at 0.05 s, which is frame 10.
    assert!(text.contains("first difference: frame 11, particle"), "{text}");
    let found: Value = serde_json::from_str(&diff("other", 1, &["--json"])).unwrap();
    assert_eq!(found["first"]["frame"], 11);
    assert_eq!(found["statistics"]["frame"], 11);
    let growth = found["growth"].as_array().unwrap();
    let of = |frame: u32| {
        let row = growth
            .iter()
            .find(|row| row["frame"] == frame && row["column"] == "position");
        row.unwrap()["max"].as_f64().unwrap()
    };
    assert!(of(24) > of(12) && of(12) > 0.0, "{growth:?}");
    diff("nothing", 2, &[]);
    fs::create_dir(place.path("empty")).unwrap();
    diff("empty", 2, &[]);
}
