//! What guards do to a run, as a user meets it: where it stops, what it leaves, that this can be replayed, that a smaller step
//! helps, and that shipped scenes are left alone.

#![cfg(unix)]

use std::fs;

use serde_json::{Value, json};
use sliceflow::guards::{GUARDS, GuardKind};

use crate::place::{FRAMES, Place};

/// Grains at rest that a change of gravity presses through the floor after a while.
fn grains() -> Value {
    json!({
        "dimensions": 2,
        "domain": { "min": [0, 0], "max": [1, 1] },
        "gravity": [0, -1],
        "grains": { "radius": 0.02, "density": 1000, "spring": 2e4, "restitution": 0.5 },
        "bodies": [{ "shape": { "kind": "box", "min": [0, 0], "max": [0.4, 0.4] }, "jitter": 0.01, "spacing": 0.041 }],
        "time": { "duration": 0.1, "fps": 100 },
        "render": { "size": [64, 64] },
    })
}

fn water() -> Value {
    json!({
        "dimensions": 2,
        "domain": { "min": [0, 0], "max": [0.6, 0.6] },
        "gravity": [0, -10],
        "fluid": { "solver": "wcsph", "spacing": 0.02 },
        "bodies": [{ "shape": { "kind": "box", "min": [0, 0], "max": [0.2, 0.4] } }],
        "time": { "duration": 0.2, "fps": 50 },
        "render": { "size": [64, 64] },
    })
}

/// Blocks of water that meet at twice the speed of sound, without walls.
fn jets() -> Value {
    let block = |left: f64, speed: f64| json!({ "shape": { "kind": "box", "min": [left, 0.4], "max": [left + 0.29, 0.6] }, "velocity": [speed, 0] });
    json!({
        "dimensions": 2,
        "domain": { "min": [0, 0], "max": [1, 1], "walls": "open" },
        "gravity": [0, 0],
        "fluid": { "solver": "wcsph", "spacing": 0.02, "gamma": 1, "sound_speed": 1, "max_speed": 0.5 },
        "bodies": [block(0.2, 2.0), block(0.51, -2.0)],
        "time": { "duration": 0.1, "fps": 100 },
        "render": { "size": [64, 64] },
    })
}

/// An incompressible fluid that a piston presses into half of the room which it needs.
fn squeezed() -> Value {
    json!({
        "dimensions": 2,
        "domain": { "min": [0, 0], "max": [0.24, 0.2] },
        "gravity": [0, -10],
        "fluid": { "spacing": 0.02, "max_iterations": 5 },
        "bodies": [{ "shape": { "kind": "box", "min": [0, 0], "max": [0.2, 0.2] } }],
        "colliders": [{
            "name": "piston",
            "shape": { "kind": "box", "min": [0.2, 0], "max": [0.24, 0.2] },
            "path": [{ "at": 0, "offset": [0, 0] }, { "at": 0.4, "offset": [-0.1, 0] }]
        }],
        "time": { "duration": 0.5, "fps": 50, "step": 1e-3 },
        "render": { "size": [64, 64] },
    })
}

fn with(mut scene: Value, changes: &[(&str, Value)]) -> Value {
    for (pointer, value) in changes {
        let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
        scene.pointer_mut(parent).expect("a parent")[key] = value.clone();
    }
    scene
}

impl Place {
    fn write(&self, scene: &Value) {
        fs::write(self.path("scene.json"), scene.to_string()).unwrap();
    }

    fn report(&self, run: &str) -> Value {
        let text = fs::read(self.path(run).join("post_mortem/report.json")).expect("a report");
        serde_json::from_slice(&text).unwrap()
    }

    /// Runs a scene that a guard stops; what is told, and the report.
    fn stopped(&self, scene: &Value, more: &[&str]) -> (String, Value) {
        self.write(scene);
        let more = [&["--no-pictures", "--force"], more].concat();
        let told = self.told(&mut self.run("run", &more), 1);
        (told, self.report("run"))
    }
}

/// From rest, gravity 10⁹ times as large throws every grain through the floor.
fn lost_later() -> Value {
    with(
        grains(),
        &[(
            "/events",
            json!([{ "at": 0.055, "set": { "gravity": [0, -1e9] } }]),
        )],
    )
}

#[test]
fn a_guard_leaves_a_post_mortem_that_replays() {
    let place = Place::new();
    place.write(&lost_later());
    let told = place.told(&mut place.run("run", &[]), 1);
    assert!(told.contains("left the domain through a closed side"), "{told}");
    assert!(told.contains("likely cause:") && told.contains("help:"), "{told}");
    assert!(told.contains("sliceflow resume run"), "{told}");

    let report = place.report("run");
    assert_eq!(report["guard"], "lost");
    assert_eq!(
        (&report["frame"], &report["last_good_frame"]),
        (&json!(6), &json!(5))
    );
    assert_eq!(report["last_good_checkpoint"], "checkpoint_000005.bin");
    assert!(place.path("run/checkpoint_000005.bin").exists());
    // Good frames are there, and no others.
    assert!(place.path("run/frame_000005.png").exists() && !place.path("run/frame_000006.png").exists());
    assert!(place.path("run/particles_000005").exists() && !place.path("run/particles_000006").exists());

    let caught = &report["caught"];
    assert_eq!(report["particle"]["id"], caught["id"]);
    assert!(caught["velocity_m_per_s"][1].as_f64().unwrap() < -1e4, "{caught}");
    let neighbors = report["neighbors"].as_array().unwrap();
    assert!(!neighbors.is_empty() && neighbors.len() <= 12, "{neighbors:?}");
    let center = &report["particle"]["position_m"];
    for neighbor in neighbors {
        let along =
            |axis: usize| neighbor["position_m"][axis].as_f64().unwrap() - center[axis].as_f64().unwrap();
        let distance = along(0).hypot(along(1));
        assert!(
            (distance - neighbor["distance_m"].as_f64().unwrap()).abs() < 1e-6,
            "{neighbor}"
        );
        assert!(distance < 0.06, "{neighbor}");
    }

    // The picture shows the particle in its middle, and neighbors beside it.
    let picture = image::open(place.path("run/post_mortem/neighborhood.png"))
        .unwrap()
        .to_rgb8();
    let (width, height) = picture.dimensions();
    let middle = picture.get_pixel(width / 2, height / 2).0;
    assert!(
        middle[0] > 150 && middle[1] > 150 && middle[2] < 120,
        "not yellow: {middle:?}"
    );
    let is_green = |[r, g, b]: [u8; 3]| g > r && g > b && g > 60;
    assert!(picture.pixels().any(|pixel| is_green(pixel.0)), "no neighbor");

    // Replayed from the last good checkpoint, it comes to the same.
    let told = place.told(&mut place.sliceflow(&["resume", "run"]), 1);
    assert!(told.contains("going on after frame 5"), "{told}");
    for key in [
        "guard",
        "caught",
        "frame",
        "step",
        "time_s",
        "last_good_frame",
        "last_good_checkpoint",
    ] {
        assert_eq!(place.report("run")[key], report[key], "{key}");
        assert!(!report[key].is_null(), "{report}");
    }

    // A variant without that event goes on.
    let set = [
        "resume",
        "run",
        "--branch-at",
        "5",
        "--set",
        "events=[]",
        "--out",
        "mended",
    ];
    place.told(&mut place.sliceflow(&set), 0);
    assert!(!place.path("mended/post_mortem").exists());

    // What a run has left is replaced by the next one.
    place.write(&grains());
    place.told(&mut place.run("run", &["--force"]), 0);
    assert!(!place.path("run/post_mortem").exists());
}

/// Soft grains that remember contacts, in four blocks that fly through each other.
fn crossing() -> Value {
    let block = |x: f64, y: f64, u: f64, v: f64| {
        let (min, max) = ([x, y], [x + 0.25, y + 0.25]);
        json!({ "shape": { "kind": "box", "min": min, "max": max }, "velocity": [u, v], "spacing": 0.041 })
    };
    let blocks = [
        block(0.0, 0.4, 4.0, 0.0),
        block(0.8, 0.4, -4.0, 0.0),
        block(0.4, 0.0, 0.0, 4.0),
        block(0.4, 0.8, 0.0, -4.0),
    ];
    with(
        grains(),
        &[
            ("/domain/max", json!([1.05, 1.05])),
            ("/gravity", json!([0, 0])),
            ("/grains/law", json!("linear")),
            ("/grains/friction", json!(0.3)),
            ("/grains/spring", json!(20)),
            ("/bodies", json!(blocks)),
            ("/time", json!({ "duration": 1, "fps": 2, "step": 2e-4 })),
        ],
    )
}

/// Fluid without walls at so many times the speed of sound.
fn thrown(sound: f64) -> Value {
    with(
        jets(),
        &[
            ("/bodies/0/velocity", json!([sound, 0])),
            ("/bodies/1/velocity", json!([sound, 0])),
            ("/time/adaptive", json!(true)),
        ],
    )
}

/// A scene that a guard stops, with arguments, and whether the guard tells of one particle. No scene that is accepted comes to
/// a number that is none, or so far, before another guard stops it: `tests/library/grains.rs` begins there.
fn made_for(guard: GuardKind) -> Option<(Value, &'static [&'static str], bool)> {
    let fast_grains = |speed: f64| {
        with(
            grains(),
            &[
                ("/bodies/0/velocity", json!([0, speed])),
                ("/domain/walls", json!("open")),
            ],
        )
    };
    Some(match guard {
        GuardKind::NotFinite | GuardKind::Edge => return None,
        GuardKind::Lost => (lost_later(), &[], true),
        GuardKind::Runaway => (thrown(150.0), &[], true),
        // Fast enough to pass through others.
        GuardKind::TooFast => (fast_grains(1e3), &[], true),
        GuardKind::Crowded => (crossing(), &[], true),
        // So fast that steps shrink to nothing.
        GuardKind::StalledStep => (
            with(fast_grains(1e7), &[("/time/adaptive", json!(true))]),
            &[],
            false,
        ),
        // A pressure against which nothing stands.
        GuardKind::Energy => (
            with(
                thrown(0.0),
                &[
                    ("/fluid/background_pressure", json!(100)),
                    ("/time/fps", json!(20)),
                    ("/time/duration", json!(1)),
                ],
            ),
            &[],
            false,
        ),
        GuardKind::Density => (jets(), &[], false),
        // So soft that the lowest grains sink into each other.
        GuardKind::Overlap => (
            with(
                grains(),
                &[("/grains/spring", json!(20)), ("/gravity", json!([0, -10]))],
            ),
            &[],
            false,
        ),
        // Voxels with one slot for several particles.
        GuardKind::Overflow => (
            with(water(), &[("/time/duration", json!(0.04))]),
            &["--grid", "uniform-pool", "--set", "neighbors.slots=1"],
            false,
        ),
        GuardKind::Unconverged => (squeezed(), &[], false),
    })
}

#[test]
fn each_guard_fires_on_a_scene_made_for_it_and_replays() {
    let place = Place::new();
    let mut wrong = Vec::new();
    for row in &GUARDS {
        let Some((scene, more, is_of_one)) = made_for(row.kind) else {
            continue;
        };
        let (told, report) = place.stopped(&scene, more);
        println!("{}: {}\n{told}", row.word, report["guard"]);
        if report["guard"] != row.word || report["caught"].is_object() != is_of_one {
            wrong.push(format!("{}: {report}", row.word));
            continue;
        }
        assert!(told.contains(row.what) && told.contains(row.cause), "{told}");
        // Of all particles that went wrong in that step, the same one is told again.
        place.told(&mut place.sliceflow(&["resume", "run"]), 1);
        let again = place.report("run");
        for key in [
            "guard",
            "frame",
            "step",
            "caught",
            "likely_cause",
            "last_good_frame",
        ] {
            assert_eq!(again[key], report[key], "{}: {key}", row.word);
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_retry_goes_back_with_half_the_step_and_can_be_resumed() {
    let place = Place::new();
    place.write(&with(
        water(),
        &[("/time/step", json!(4e-3)), ("/time/duration", json!(0.3))],
    ));
    let retry = ["--no-pictures", "--on-instability", "retry"];
    let told = place.told(&mut place.run("whole", &retry), 0);
    assert!(
        told.contains("retrying at the beginning with steps of half the length (1 of 5 times)"),
        "{told}"
    );
    let manifest = place.manifest("whole");
    let retries = manifest["retries"].as_array().unwrap();
    assert!(
        !retries.is_empty() && manifest["status"] == "finished",
        "{manifest}"
    );
    let steps: Vec<f64> = retries
        .iter()
        .map(|retry| retry["step_s"].as_f64().unwrap())
        .collect();
    assert!(steps.windows(2).all(|pair| pair[1] < pair[0]), "{steps:?}");
    let last = fs::read_to_string(place.path("whole/stats.jsonl")).unwrap();
    let last: Value = serde_json::from_str(last.lines().last().unwrap()).unwrap();
    let step = last["step_s"].as_f64().unwrap();
    assert!(
        (step - 0.5 * steps[steps.len() - 1]).abs() < 1e-3 * step,
        "{step} after {steps:?}"
    );
    assert!(!place.path("whole/post_mortem").exists());

    // Cut off on its way, the run keeps its steps.
    let more = [&retry[..], &["--frames", "8"]].concat();
    place.told(&mut place.run("part", &more), 0);
    let told = place.told(&mut place.sliceflow(&["resume", "part", "--frames", "16"]), 0);
    assert!(told.contains("going on after frame 7"), "{told}");
    place.assert_same("whole", "part", "a run that was resumed after a retry");
    let retried = |run: &str| -> Vec<Value> {
        let retries = place.manifest(run)["retries"].as_array().unwrap().clone();
        let told = |retry: &Value| json!([retry["from_frame"], retry["step_s"], retry["message"]]);
        retries.iter().map(told).collect()
    };
    assert_eq!(retried("part"), retried("whole"));
}

/// Where smaller steps do not help either, it stops as without retries.
#[test]
fn a_retry_that_does_not_help_ends_with_a_post_mortem() {
    let place = Place::new();
    place.write(&lost_later());
    let retry = [
        "--no-pictures",
        "--on-instability",
        "retry",
        "--checkpoint-every",
        "2",
    ];
    let told = place.told(&mut place.run("run", &retry), 1);
    assert!(
        told.contains("retrying after frame 4") && told.contains("(5 of 5 times)"),
        "{told}"
    );
    let report = place.report("run");
    assert_eq!(
        (&report["guard"], &report["last_good_frame"]),
        (&json!("lost"), &json!(5))
    );
    assert_eq!(place.manifest("run")["retries"].as_array().unwrap().len(), 5);
}

#[test]
fn a_run_stops_before_its_files_take_too_much() {
    let place = Place::new();
    let plain = ["--no-pictures", "--set", "sensors=[]"];
    place.told(&mut place.run("whole", &plain), 0);
    let bytes = |run: &str| -> u64 {
        let mut folders = vec![place.path(run)];
        let mut sum = 0;
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).unwrap() {
                let entry = entry.unwrap();
                match entry.file_type().unwrap().is_dir() {
                    true => folders.push(entry.path()),
                    false => sum += entry.metadata().unwrap().len(),
                }
            }
        }
        sum
    };
    let all = bytes("whole");
    let max = all * 4 / 5;
    // Checkpoints on the way would only make it stop earlier.
    let text = max.to_string();
    let bound = ["--max-disk", &text, "--keep-checkpoints", "1"];
    let told = place.told(&mut place.run("run", &[&plain[..], &bound].concat()), 1);
    assert!(
        told.contains("the run stops at --max-disk") && told.contains("resume"),
        "{told}"
    );
    let manifest = place.manifest("run");
    assert_eq!(manifest["status"], "interrupted");
    let done = manifest["frames_done"].as_u64().unwrap();
    assert!((2..u64::from(FRAMES)).contains(&done), "{done} frames");
    assert!(bytes("run") <= max, "{} of {max}", bytes("run"));

    // With the same bound, nothing more fits; with a larger one, it comes to the bytes of a run without any.
    let told = place.told(&mut place.sliceflow(&["resume", "run"]), 1);
    assert!(told.contains("the run stops at --max-disk"), "{told}");
    place.told(&mut place.sliceflow(&["resume", "run", "--max-disk", "1GB"]), 0);
    place.assert_same("whole", "run", "a run that had stopped at --max-disk");

    let refused = place.told(&mut place.run("small", &["--max-disk", "1kB"]), 1);
    assert!(
        refused.contains("more than the 1000 B of --max-disk"),
        "{refused}"
    );
    assert!(!place.path("small").exists());
}

/// A handful of the scenes that ship, at small size: those with sources of energy, with soft grains, and with both solvers.
#[test]
fn guards_leave_shipped_scenes_alone() {
    let place = Place::new();
    let small: [(&str, &[&str]); 6] = [
        ("couette", &["--set", "fluid.spacing=0.1", "--frames", "6"]),
        ("dam_break_2d", &["--set", "fluid.spacing=0.04", "--frames", "40"]),
        (
            "harada_droplet",
            &["--set", "fluid.spacing=0.1", "--frames", "12"],
        ),
        ("standing_wave", &["--frames", "4"]),
        ("column_2d", &["--frames", "6"]),
        (
            "elliptical_drop",
            &["--set", "fluid.spacing=0.1", "--frames", "6"],
        ),
    ];
    for (scene, more) in small {
        let args = [&["run", scene, "--no-pictures", "--out", scene], more].concat();
        let told = place.told(&mut place.sliceflow(&args), 0);
        assert!(!place.path(scene).join("post_mortem").exists(), "{told}");
    }
}
