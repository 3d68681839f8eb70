//! The first Ctrl-C: an answer at once, an end as soon as nothing is lost by it, and everything finished kept.

#![cfg(unix)]

use std::io::Read as _;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::place::{Place, wait_for};

/// Far longer than anything here should take, and far shorter than what must not be waited for.
const PATIENCE: Duration = Duration::from_secs(180);

/// A block of grains falls.
const SCENE: &str = r#"{
  "dimensions": 2,
  "domain": { "min": [0, 0], "max": [1, 1] },
  "grains": { "radius": 0.02, "density": 1000, "spring": 20000, "restitution": 0.5 },
  "bodies": [ { "shape": { "kind": "box", "min": [0.1, 0.1], "max": [0.5, 0.5] }, "spacing": 0.041 } ],
  "time": { "duration": 1000, "fps": 200 },
  "render": { "size": [64, 48] }
}"#;

fn place() -> Place {
    let place = Place::new();
    std::fs::write(place.path("scene.json"), SCENE).unwrap();
    place
}

fn start(command: &mut Command) -> Child {
    command.stderr(Stdio::piped()).spawn().unwrap()
}

/// Ctrl-C, then the end: what was told.
fn interrupt(mut run: Child) -> String {
    let id = run.id().to_string();
    Command::new("kill").args(["-INT", &id]).status().unwrap();
    let asked = Instant::now();
    while run.try_wait().unwrap().is_none() {
        if asked.elapsed() > PATIENCE {
            run.kill().unwrap();
            panic!("it goes on");
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    let mut told = String::new();
    run.stderr.take().unwrap().read_to_string(&mut told).unwrap();
    assert_eq!(run.wait().unwrap().code(), Some(130), "{told}");
    told
}

#[test]
fn a_frame_without_end_is_given_up_where_nothing_is_lost() {
    let place = place();
    // Frame 1 has some hours of simulated time, with lists and without.
    for (out, skin) in [("listed", "0.1"), ("plain", "0")] {
        let skin = format!("neighbors.skin={skin}");
        let more = [
            "--set",
            "time.fps=5e-5",
            "--set",
            "time.duration=4e4",
            "--set",
            &skin,
        ];
        let mut run = start(&mut place.run(out, &more));
        wait_for(&place.path(out).join("stats.jsonl"), &mut run);
        // Now it listens; most likely the frame without end has begun too.
        std::thread::sleep(Duration::from_secs(1));
        let told = interrupt(run);
        assert!(
            told.contains("note: stopping; Ctrl-C again ends at once"),
            "{told}"
        );
        let manifest = place.manifest(out);
        assert_eq!(manifest["status"], "interrupted");
        let frames = manifest["frames_done"].as_u64().unwrap();
        assert!(frames <= 1, "{frames}");
        assert_eq!(place.path(out).join("frame_000000.png").exists(), frames == 1);
    }
}

#[test]
fn what_is_waited_for_is_told() {
    let place = place();
    let more = ["--checkpoint-every", "1h"];
    let mut run = start(&mut place.run("run", &more));
    wait_for(&place.path("run/frame_000003.png"), &mut run);
    let told = interrupt(run);
    assert!(
        told.contains("note: stopping when frame ") && told.contains("so that its state can be saved"),
        "{told}"
    );
    let frames = place.manifest("run")["frames_done"].as_u64().unwrap();
    assert_eq!(
        place.checkpoints("run"),
        [format!("checkpoint_{:06}.bin", frames - 1)]
    );
    assert!(
        told.contains(&format!("interrupted; {frames} finished frames are on disk")),
        "{told}"
    );
    place.told(
        &mut place.sliceflow(&["resume", "run", "--frames", &(frames + 2).to_string()]),
        0,
    );
}

/// Frames that take long are not waited for, and their state is not lost either.
#[test]
fn long_frames_resume_to_the_same_bytes() {
    let place = place();
    let long = ["--set", "time.fps=0.4", "--set", "time.duration=25"];
    place.told(&mut place.run("whole", &long), 0);
    let mut run = start(&mut place.run("run", &long));
    let patience = Instant::now();
    let lines = |path: &std::path::Path| std::fs::read_to_string(path).map_or(0, |text| text.lines().count());
    while lines(&place.path("run/stats.jsonl")) < 2 && run.try_wait().unwrap().is_none() {
        assert!(patience.elapsed() < PATIENCE);
        std::thread::sleep(Duration::from_millis(20));
    }
    interrupt(run);
    let frames = place.manifest("run")["frames_done"].as_u64().unwrap();
    assert_eq!(
        place.checkpoints("run"),
        [format!("checkpoint_{:06}.bin", frames - 1)]
    );
    let told = place.told(&mut place.sliceflow(&["resume", "run"]), 0);
    assert!(
        told.contains(&format!("going on after frame {}", frames - 1)),
        "{told}"
    );
    place.assert_same("whole", "run", "a run that was interrupted");
}

#[test]
fn a_study_keeps_the_parts_that_were_finished() {
    let place = Place::new();
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("sliceflow"));
    command
        .current_dir(place.path(""))
        .args(["study", "harada", "--scale", "tiny", "-o", "study"]);
    let mut run = start(&mut command);
    let page = place.path("study/harada.md");
    wait_for(&page, &mut run);
    let told = interrupt(run);
    assert!(told.contains("stopping; finished parts are kept"), "{told}");
    assert!(told.contains("interrupted; finished: table_1"), "{told}");
    let page = std::fs::read_to_string(page).unwrap();
    assert!(
        page.contains("## Table 1") && page.contains("## Missing"),
        "{page}"
    );
    let json: serde_json::Value =
        serde_json::from_slice(&std::fs::read(place.path("study/harada.json")).unwrap()).unwrap();
    assert!(json["table_1"].is_array() && json["resizing"].is_null(), "{json}");
    let missing = json["missing"].as_array().unwrap();
    assert!(missing.contains(&"resizing".into()) && !missing.contains(&"table_1".into()));
}

#[test]
fn a_benchmark_keeps_what_was_measured() {
    let place = Place::new();
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("sliceflow"));
    command
        .current_dir(place.path(""))
        .args(["bench", "--size", "tiny", "--json", "bench.json"]);
    let mut run = start(&mut command);
    let file = place.path("bench.json");
    let runs = || -> usize {
        let json: serde_json::Value =
            serde_json::from_slice(&std::fs::read(&file).unwrap_or_default()).unwrap_or_default();
        json["runs"].as_array().map_or(0, Vec::len)
    };
    let patience = Instant::now();
    while runs() == 0 && run.try_wait().unwrap().is_none() {
        assert!(patience.elapsed() < PATIENCE);
        std::thread::sleep(Duration::from_millis(20));
    }
    let told = interrupt(run);
    assert!(told.contains("interrupted; "), "{told}");
    let json: serde_json::Value = serde_json::from_slice(&std::fs::read(&file).unwrap()).unwrap();
    assert_eq!(json["interrupted"], true);
    let left_out = json["left_out"].as_array().unwrap().len();
    assert!(runs() >= 1 && left_out >= 1 && runs() + left_out == 7, "{json}");
}
