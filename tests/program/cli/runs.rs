//! `run`: what it writes, and what stops it.

use std::fs;
use std::path::Path;

use serde_json::Value;
use sliceflow::scene::npy::Array;

use super::{ONE_CHECKPOINT, failure, files, output, read_json, short_run, sliceflow};

#[test]
fn a_run_writes_frames_statistics_particles_and_a_manifest() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let columns = [
        "--particles",
        "npy",
        "--columns",
        "position,id",
        "--progress",
        "json",
    ];
    let assert = sliceflow(&short_run(out.to_str().unwrap(), &columns))
        .assert()
        .success();
    assert!(assert.get_output().stdout.is_empty());

    for frame in 0..3 {
        let picture = image::open(out.join(format!("frame_{frame:06}.png"))).unwrap();
        assert_eq!((picture.width(), picture.height()), (160, 120));
        let arrays = out.join(format!("particles_{frame:06}"));
        let shape = |name: &str| Array::parse(&fs::read(arrays.join(name)).unwrap()).unwrap().shape;
        assert_eq!(shape("position.npy")[0], 2000);
        assert_eq!(shape("id.npy"), [2000]);
    }
    assert_eq!(
        fs::read_dir(&out).unwrap().count(),
        3 + 3 + 3,
        "no frame too many, no partial file left"
    );

    let statistics = fs::read_to_string(out.join("stats.jsonl")).unwrap();
    let lines: Vec<Value> = statistics
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    assert_eq!(lines.len(), 3);
    assert_eq!(lines[2]["frame"], 2);
    assert!((lines[2]["time_s"].as_f64().unwrap() - 2e-3).abs() < 1e-9);

    let manifest = read_json(&out.join("run.json"));
    assert_eq!(manifest["status"], "finished");
    assert_eq!(manifest["frames_done"], 3);
    assert_eq!(manifest["scene"]["time"]["fps"], 1000.0);
    assert_eq!(
        manifest["particle_steps"].as_u64().unwrap(),
        2000 * lines[2]["steps"].as_u64().unwrap()
    );

    let log = String::from_utf8(assert.get_output().stderr.clone()).unwrap();
    let events = log
        .lines()
        .map(|line| serde_json::from_str::<Value>(line).unwrap());
    assert_eq!(events.filter(|event| event["event"] == "frame").count(), 3);
}

#[test]
fn an_earlier_run_is_replaced_only_with_force() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let first = [
        "run",
        "column_2d",
        "--out",
        out,
        "--frames",
        "3",
        "--fps",
        "1000",
        "--size",
        "80x60",
    ];
    sliceflow(&first).assert().success();
    for mine in ["notes.txt", "frame_000007.png"] {
        fs::write(folder.path().join(mine), "mine").unwrap();
    }
    let old = fs::read(folder.path().join("frame_000000.png")).unwrap();
    let message = failure(&short_run(out, &[]), 2);
    assert!(
        message.contains("3 frames") && message.contains("--force"),
        "{message}"
    );
    assert_eq!(fs::read(folder.path().join("frame_000000.png")).unwrap(), old);

    let fewer = [
        "run",
        "column_2d",
        "--out",
        out,
        "--frames",
        "2",
        "--fps",
        "1000",
        "--force",
    ];
    let assert = sliceflow(&fewer).assert().success();
    let told = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
    assert!(
        told.contains("removed") && told.contains("frame_000007.png"),
        "{told}"
    );
    assert!(
        !folder.path().join("frame_000002.png").exists(),
        "beyond the new run's frames"
    );
    assert!(
        folder.path().join("frame_000007.png").exists(),
        "no run has recorded it"
    );
    assert_eq!(
        fs::read_to_string(folder.path().join("notes.txt")).unwrap(),
        "mine"
    );
    assert_ne!(fs::read(folder.path().join("frame_000000.png")).unwrap(), old);
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_keeps_its_frames_and_says_so() {
    use std::process::{Command, Stdio};

    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let args = [
        "run",
        "column_2d",
        "--out",
        out,
        "--frames",
        "100000",
        "--fps",
        "1000",
        "--size",
        "64x48",
    ];
    let program = assert_cmd::cargo::cargo_bin!("sliceflow");
    let mut run = Command::new(program)
        .args(args)
        .args(ONE_CHECKPOINT)
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    while !folder.path().join("frame_000001.png").exists() {
        assert!(run.try_wait().unwrap().is_none(), "it ended by itself");
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    Command::new("kill")
        .args(["-INT", &run.id().to_string()])
        .status()
        .unwrap();
    assert_eq!(run.wait().unwrap().code(), Some(130));

    let manifest = read_json(&folder.path().join("run.json"));
    assert_eq!(manifest["status"], "interrupted");
    let frames = manifest["frames_done"].as_u64().unwrap();
    assert_eq!(fs::read_dir(folder.path()).unwrap().count() as u64, frames + 3);
    assert_eq!(
        fs::read_to_string(folder.path().join("stats.jsonl"))
            .unwrap()
            .lines()
            .count() as u64,
        frames
    );
}

#[test]
fn a_folder_that_cannot_be_written_is_told_before_anything_runs() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    let out = file.join("out");
    let message = failure(&short_run(out.to_str().unwrap(), &[]), 1);
    assert!(
        message.contains(out.to_str().unwrap()) && message.contains("--out"),
        "{message}"
    );
    assert!(!message.contains("frame"), "{message}");
}

#[test]
fn two_runs_write_the_same_bytes() {
    let temporary = tempfile::tempdir().expect("a folder");
    let out = |name: &str| temporary.path().join(name).display().to_string();
    for name in ["one", "two"] {
        let out = out(name);
        let arguments = [
            "run",
            "harada_figure_2_small",
            "--out",
            &out,
            "--frames",
            "4",
            "--size",
            "320x180",
            "--particles",
            "npy",
            "--view",
            "both",
            "--progress",
            "plain",
        ];
        sliceflow(&arguments).args(ONE_CHECKPOINT).assert().success();
    }
    let (one, two) = (files(Path::new(&out("one"))), files(Path::new(&out("two"))));
    assert_eq!(one.len(), 4 + 4 * 6 + 2, "{:?}", one.keys());
    assert_eq!(one.keys().collect::<Vec<_>>(), two.keys().collect::<Vec<_>>());
    for (name, bytes) in &one {
        assert!(bytes == &two[name], "{name} differs");
    }
}

#[test]
fn every_scene_that_ships_runs_without_a_warning() {
    let temporary = tempfile::tempdir().expect("a folder");
    let listed = output(&["scenes"]);
    let scenes =
        std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/scenes")).expect("scenes");
    for scene in scenes {
        let path = scene.expect("an entry").path();
        let name = path.file_stem().expect("a name").to_str().expect("text");
        assert!(listed.contains(name), "{name} is not listed:\n{listed}");
        let out = temporary.path().join(name).display().to_string();
        // The second frame is near the first one: a few steps are as many as a warning needs.
        let text = std::fs::read_to_string(&path).expect("a scene");
        let scene: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        let fps = 8.0 * scene["time"]["fps"].as_f64().expect("a rate");
        let arguments = [
            "run",
            name,
            "--out",
            &out,
            "--frames",
            "2",
            "--fps",
            &fps.to_string(),
            "--size",
            "160x90",
            "--progress",
            "plain",
        ];
        let run = sliceflow(&arguments).assert().success();
        let told = String::from_utf8_lossy(&run.get_output().stderr).into_owned();
        let warnings: Vec<_> = told
            .lines()
            .filter(|l| l.starts_with("warning") && !l.contains("software"))
            .collect();
        assert!(warnings.is_empty(), "{name}: {warnings:?}");
    }
}
