//! What disks do to runs: they fill up, they vanish, they may not be written.

#![cfg(unix)]

use std::fs;
use std::process::{Command, Output};

use crate::place::{Place, start, wait_for};

/// The program on a disk that has only so much room: a file system in memory, mounted as `full` in a namespace of its own.
/// What is there at the end is copied to `kept`. `None` where none can be mounted.
#[cfg(target_os = "linux")]
fn on_small_disk(place: &Place, room: &str, args: &str) -> Option<Output> {
    let program = assert_cmd::cargo::cargo_bin!("sliceflow").display();
    let script = format!(
        "mount -t tmpfs -o size={room} none full || exit 99; {program} {args} --progress plain; \
         status=$?; cp -r full kept; exit $status"
    );
    fs::create_dir(place.path("full")).unwrap();
    let output = Command::new("unshare")
        .args(["--map-root-user", "--mount", "sh", "-c", &script])
        .current_dir(place.path(""))
        .output();
    match output {
        Ok(output) if place.path("kept").exists() => Some(output),
        other => {
            eprintln!("skipped: no file system can be mounted here ({other:?})");
            None
        }
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_checkpoint_that_cannot_be_written_is_told_and_stops_nothing() {
    let place = Place::new();
    // Thousands of grains make a checkpoint that does not fit, while everything else does.
    let args = "run scene.json --set grains.radius=0.003 --set bodies[0].spacing=0.0062 --set emitters=[] --set sensors=[] --size 32x24 \
                --frames 4 --fps 1000 --checkpoint-every 2 --out full/small";
    let Some(output) = on_small_disk(&place, "100k", args) else {
        return;
    };
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{told}");
    assert!(told.contains("no checkpoint was written after frame 2"), "{told}");
    assert!(place.checkpoints("kept/small").is_empty());
    assert_eq!(
        place.files("kept/small").len(),
        4 + 1,
        "nothing half-written stays"
    );
}

#[cfg(all(target_os = "linux", feature = "rerun"))]
#[test]
fn a_recording_that_has_no_room_is_an_error() {
    let place = Place::new();
    let args = "run scene.json --no-pictures --frames 6 --fps 1000 --out out --rerun full/large.rrd";
    let Some(output) = on_small_disk(&place, "8k", args) else {
        return;
    };
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{told}");
    assert!(
        told.contains("large.rrd") && told.contains("free space"),
        "{told}"
    );
}

#[test]
fn a_folder_that_vanishes_ends_a_run_and_is_not_made_anew() {
    let place = Place::new();
    for (out, kinds, first) in [
        ("pictures", &["--no-statistics"][..], "frame_000000.png"),
        ("statistics", &["--no-pictures"], "stats.jsonl"),
        (
            "arrays",
            &["--no-pictures", "--no-statistics", "--particles", "npy"],
            "particles_000000",
        ),
    ] {
        let args = ["run", "scene.json", "--frames", "20000", "--out", out];
        let mut command = place.sliceflow(&[&args, kinds].concat());
        let mut run = start(&mut command);
        wait_for(&place.path(out).join(first), &mut run);
        // What is written meanwhile may keep the folder alive for a moment.
        while place.path(out).exists() {
            let _ = fs::remove_dir_all(place.path(out));
        }
        assert_eq!(run.wait().unwrap().code(), Some(1), "{out}");
        assert!(!place.path(out).exists(), "{out}");
    }
}

/// Files of a run that a disk stopped are those of a whole one, as far as they go.
fn assert_undamaged(place: &Place, whole: &str, run: &str) {
    let before = place.files(whole);
    for (name, bytes) in place.files(run) {
        match name.as_str() {
            "stats.jsonl" | "sensors.csv" | "sensor_layers.csv" => {
                assert!(before[&name].starts_with(&bytes), "{name}");
            }
            _ => assert!(bytes == before[&name], "{name} is damaged"),
        }
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_disk_that_fills_up_ends_a_run_and_damages_nothing() {
    let place = Place::new();
    place.told(&mut place.run("whole", &["--checkpoint-every", "5"]), 0);
    // Room for half a run.
    let args = "run scene.json --particles npy --checkpoint-every 5 --out full/run";
    let Some(output) = on_small_disk(&place, "700k", args) else {
        return;
    };
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{told}");
    assert!(
        told.contains("No space left") && told.contains("free space there"),
        "{told}"
    );
    assert!(told.contains("go on with `sliceflow resume full/run`"), "{told}");
    assert_undamaged(&place, "whole", "kept/run");
    assert!(place.files("kept/run").len() > 20, "most of it is there");
    // With room again it goes on.
    place.told(&mut place.sliceflow(&["resume", "kept/run"]), 0);
    place.assert_same("whole", "kept/run", "a disk that was full");
}

/// As a user who may read a folder but not write it; root may write everything, so root becomes nobody.
#[test]
fn a_folder_that_may_only_be_read_is_told_and_left_as_it_is() {
    use std::os::unix::fs::PermissionsExt as _;
    use std::os::unix::process::CommandExt as _;
    const NOBODY: u32 = 65_534;
    let place = Place::new();
    place.told(&mut place.run("run", &["--frames", "3"]), 0);
    let set_mode = |name: &str, mode: u32| {
        fs::set_permissions(place.path(name), fs::Permissions::from_mode(mode)).unwrap();
    };
    set_mode("", 0o755);
    set_mode("run", 0o555);
    let before = place.files("run");
    let is_root = fs::write(place.path("run/trial"), "").is_ok();
    if is_root {
        fs::remove_file(place.path("run/trial")).unwrap();
    }
    for (args, expected) in [
        (
            &["run", "scene.json", "--out", "run/deeper"][..],
            "cannot create run/deeper",
        ),
        (
            &["run", "scene.json", "--out", "run", "--force"],
            "cannot write into run",
        ),
        (&["resume", "run", "--frames", "6"], "cannot write into run"),
        (
            &["render", "run", "--out", "run/again"],
            "cannot create run/again",
        ),
    ] {
        let mut command = place.sliceflow(args);
        if is_root {
            command.uid(NOBODY).gid(NOBODY);
        }
        let output = match command.output() {
            Err(reason) if is_root && reason.kind() == std::io::ErrorKind::PermissionDenied => {
                eprintln!("skipped: nobody may not start the program ({reason})");
                break;
            }
            output => output.unwrap(),
        };
        let told = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{args:?}: {told}");
        assert!(
            told.contains(expected) && told.contains("choose a folder that you may write"),
            "{args:?}: {told}"
        );
        assert!(place.files("run") == before, "{args:?}");
    }
    set_mode("run", 0o755);
}
