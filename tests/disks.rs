//! What disks do to runs: they fill up, they vanish, they may not be written.

#![cfg(all(unix, feature = "cli"))]

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
    assert_undamaged(&place, "whole", "run");
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

/// Files of a run that a disk stopped are those of a whole one, as far as they go.
fn assert_undamaged(place: &Place, whole: &str, run: &str) {
    let before = place.files(whole);
    for (name, bytes) in place.files(run) {
        match name.as_str() {
            "stats.jsonl" => assert!(before[&name].starts_with(&bytes), "{name}"),
            _ => assert!(bytes == before[&name], "{name} is damaged"),
        }
    }
}

/// A file system in memory with room for half a run, in a mount namespace of its own.
#[cfg(target_os = "linux")]
#[test]
fn a_file_system_that_fills_up_ends_a_run_and_damages_nothing() {
    let place = Place::new();
    let often = ["--checkpoint-every", "5"];
    place.told(&mut place.run("whole", &often), 0);
    fs::create_dir(place.path("full")).unwrap();
    let program = assert_cmd::cargo::cargo_bin!("sliceflow").display();
    let script = format!(
        "mount -t tmpfs -o size=700k none full || exit 99; \
         {program} run scene.json --particles npy --checkpoint-every 5 --out full/run --progress plain; \
         status=$?; cp -r full/run kept; exit $status"
    );
    let output = Command::new("unshare")
        .args(["--map-root-user", "--mount", "sh", "-c", &script])
        .current_dir(place.path(""))
        .output();
    let output = match output {
        Ok(output) if output.status.code() == Some(1) && place.path("kept").exists() => output,
        Ok(output) if output.status.code() == Some(0) => panic!("the disk was large enough"),
        other => {
            eprintln!("skipped: no file system can be mounted here ({other:?})");
            return;
        }
    };
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(
        told.contains("No space left") && told.contains("free space there"),
        "{told}"
    );
    assert_undamaged(&place, "whole", "kept");
    assert!(place.files("kept").len() > 20, "most of it is there");
    place.told(&mut place.sliceflow(&["resume", "kept"]), 0);
    place.assert_same("whole", "kept", "a file system that was full");
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
