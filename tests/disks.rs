//! What disks do to runs: they fill up, they vanish, they may not be written.

#![cfg(unix)]

#[path = "common/place.rs"]
mod place;

use std::fs;
use std::process::Command;

use place::{Place, start, wait_for};

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
