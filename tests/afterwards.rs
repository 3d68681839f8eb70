//! What one does with runs afterwards: draw them again, compare them; and what disks do to them.

#![cfg(unix)]

#[path = "common/place.rs"]
mod place;

use std::fs;
use std::process::Command;

use place::{FRAMES, Place, start, wait_for};
use serde_json::Value;

fn pictures(place: &Place, run: &str) -> Vec<(String, Vec<u8>)> {
    let files = place.files(run).into_iter();
    files.filter(|(name, _)| name.ends_with(".png")).collect()
}

#[test]
fn pictures_are_drawn_again_from_particle_files_to_the_byte() {
    let place = Place::new();
    let colored = ["--set", "render.color.by=contacts"];
    place.told(&mut place.run("run", &colored), 0);
    let told = place.told(&mut place.sliceflow(&["render", "--from", "run"]), 0);
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
        "--from",
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
        "--from",
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
            &["render", "--from", "run", "--out", "x", "--set", "gravity=[0,0]"][..],
            2,
            "`gravity`",
        ),
        (
            &[
                "render",
                "--from",
                "run",
                "--out",
                "x",
                "--set",
                "colliders[0].shape.radius=0.1",
            ],
            2,
            "`colliders`",
        ),
        (
            &["render", "--from", "run_render", "--out", "x"],
            2,
            "was drawn from",
        ),
        (&["resume", "run_render"], 2, "was drawn from"),
        (&["render", "--from", "run", "--out", "run"], 2, "--force"),
        (
            &["render", "--from", "nothing", "--out", "x"],
            1,
            "nothing/run.json",
        ),
    ] {
        let told = place.told(&mut place.sliceflow(args), status);
        assert!(told.contains(expected), "{args:?}: {told}");
        assert!(!place.path("x").exists(), "{args:?}");
    }
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
    let told = place.told(&mut place.sliceflow(&["render", "--from", "run"]), 0);
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
    let told = place.told(&mut place.sliceflow(&["render", "--from", "bare"]), 2);
    assert!(
        told.contains("no velocity") && told.contains("render.color.by=y"),
        "{told}"
    );
    place.told(
        &mut place.sliceflow(&["render", "--from", "bare", "--set", "render.color.by=density"]),
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
    let told = place.told(&mut place.sliceflow(&["render", "--from", "none"]), 2);
    assert!(told.contains("--particles npy"), "{told}");
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

/// The program under a limit of the size of files, which fails like a full disk. A block has 512 bytes.
fn limited(place: &Place, blocks: u32, args: &str) -> Command {
    let program = assert_cmd::cargo::cargo_bin!("sliceflow").display();
    let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec {program} {args} --progress plain");
    let mut command = Command::new("sh");
    command.current_dir(place.path("")).args(["-c", &script]);
    command
}

#[test]
fn a_full_disk_ends_a_run_and_damages_nothing() {
    let place = Place::new();
    // Statistics grow past 128 KiB, while every other file stays smaller.
    let args = "run scene.json --particles npy --columns id --size 32x24 --frames 400 --fps 4000 --checkpoint-every 40 --out";
    let whole: Vec<&str> = args.split(' ').chain(["whole"]).collect();
    place.told(&mut place.sliceflow(&whole), 0);
    let told = place.told(&mut limited(&place, 256, &format!("{args} run")), 1);
    assert!(told.contains("cannot write run/stats.jsonl"), "{told}");
    assert!(told.contains("go on with `sliceflow resume run`"), "{told}");
    let before = place.files("whole");
    for (name, bytes) in place.files("run") {
        match name.as_str() {
            "stats.jsonl" => assert!(before[&name].starts_with(&bytes), "{name}"),
            _ => assert!(bytes == before[&name], "{name} is damaged"),
        }
    }
    assert_eq!(place.manifest("run")["status"], "failed");
    // With room again it goes on.
    place.told(&mut place.sliceflow(&["resume", "run"]), 0);
    place.assert_same("whole", "run", "a full disk");
}

#[test]
fn a_checkpoint_that_cannot_be_written_is_told_and_stops_nothing() {
    let place = Place::new();
    // Thousands of grains make checkpoints larger than the limit, and the manifest stays smaller.
    let args = "run scene.json --set grains.radius=0.003 --set bodies[0].spacing=0.0062 --set emitters=[] --size 32x24 \
                --frames 4 --fps 1000 --checkpoint-every 2 --out small";
    let told = place.told(&mut limited(&place, 128, args), 0);
    assert!(told.contains("no checkpoint behind frame 2"), "{told}");
    assert!(place.checkpoints("small").is_empty());
    assert_eq!(place.files("small").len(), 4 + 1, "nothing half-written stays");
}

#[test]
fn a_folder_that_vanishes_ends_a_run_and_is_not_made_anew() {
    let place = Place::new();
    for (out, kinds) in [
        ("pictures", &["--no-statistics"][..]),
        ("statistics", &["--no-pictures"]),
        (
            "arrays",
            &["--no-pictures", "--no-statistics", "--particles", "npy"],
        ),
    ] {
        let args = ["run", "scene.json", "--frames", "20000", "--out", out];
        let mut command = place.sliceflow(&[&args, kinds].concat());
        let mut run = start(&mut command);
        wait_for(&place.path(out).join("run.json"), &mut run);
        std::thread::sleep(std::time::Duration::from_millis(300));
        // What is written meanwhile may keep the folder alive for a moment.
        while place.path(out).exists() {
            let _ = fs::remove_dir_all(place.path(out));
        }
        assert_eq!(run.wait().unwrap().code(), Some(1), "{out}");
        assert!(!place.path(out).exists(), "{out}");
    }
}
