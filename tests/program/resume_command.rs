//! `sliceflow resume` as a user meets it: whatever ended a run, it comes to the bytes of one that nothing ended.

#![cfg(unix)]

use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::Duration;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore as _, SeedableRng as _};
use serde_json::{Value, json};

/// Its name, and what makes it of a usual scene.
type Case = (&'static str, fn(&mut Value));

/// Scenes that are killed: what each adds to grains that meet an obstacle, of what may be lost between two frames.
const KILLED: [Case; 4] = [
    ("grains", |_| {}),
    // Contacts have a history.
    ("grains that rub", |scene| {
        scene["grains"]["law"] = json!("linear");
        scene["grains"]["friction"] = json!(0.4);
        scene["grains"]["rolling_friction"] = json!(0.1);
    }),
    ("rigid bodies", |scene| {
        scene["grains"]["law"] = json!("linear");
        scene["grains"]["friction"] = json!(0.4);
        scene["bodies"][0]["shape"]["max"] = json!([0.1, 0.1]);
        let crates = json!({
            "shape": { "kind": "box", "min": [-0.2, 0.15], "max": [-0.1, 0.25] },
            "rigid": { "copies": { "counts": [2, 1], "step": [0.15, 0] } }
        });
        scene["bodies"].as_array_mut().expect("bodies").push(crates);
    }),
    ("water", |scene| {
        let scene = scene.as_object_mut().expect("an object");
        scene.remove("grains");
        scene.insert("fluid".into(), json!({ "solver": "dfsph", "spacing": 0.02 }));
        scene["bodies"] = json!([{ "shape": { "kind": "box", "min": [-0.3, 0], "max": [0.1, 0.3] } }]);
        scene["time"].as_object_mut().expect("times").remove("integrator");
    }),
];

use crate::place::{FRAMES, Place, start, wait_for};

/// Kills a run, and what goes on with it, `kills` times; the end is the bytes of a run that nobody killed. Each is killed
/// when there are so many files of it, whole or half-written, at random.
fn kill_and_resume((name, change): (&str, fn(&mut Value)), kills: u32, seed: u64) {
    let place = Place::new();
    let file = place.path("scene.json");
    let mut scene: Value = serde_json::from_slice(&fs::read(&file).unwrap()).unwrap();
    change(&mut scene);
    fs::write(&file, scene.to_string()).unwrap();
    place.told(&mut place.run("whole", &[]), 0);
    let files = |out: &str| walk(&place.path(out));
    let all = files("whole");
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut killed = 0;
    let mut round = 0;
    while killed < kills {
        round += 1;
        let out = format!("run_{round}");
        let every = ["--checkpoint-every", ["1", "3", "7"][round % 3]];
        let mut next = place.run(&out, &every);
        loop {
            let mut run = start(&mut next);
            let until = random.next_u32() as usize % all;
            while files(&out) < until && run.try_wait().unwrap().is_none() {
                std::thread::sleep(Duration::from_millis(1));
            }
            let ended = run.try_wait().unwrap().is_some();
            // SIGKILL.
            run.kill().unwrap();
            let status = run.wait().unwrap();
            if ended {
                assert!(status.success(), "{status}");
                break;
            }
            killed += 1;
            // A run killed before it wrote its manifest left nothing to go on with.
            next = match place.path(&out).join("run.json").exists() {
                true => place.sliceflow(&["resume", &out]),
                false => place.run(&out, &every),
            };
            if killed == kills {
                place.told(&mut next, 0);
                break;
            }
        }
        place.assert_same("whole", &out, &format!("{name}, seed {seed}, round {round}"));
        let manifest = place.manifest(&out);
        assert_eq!(
            (&manifest["status"], &manifest["frames_done"]),
            (&"finished".into(), &FRAMES.into())
        );
        assert_eq!(
            manifest["particle_steps"],
            place.manifest("whole")["particle_steps"]
        );
    }
}

/// Files and folders in a folder, and in those.
fn walk(folder: &Path) -> usize {
    let Ok(entries) = fs::read_dir(folder) else {
        return 0;
    };
    // A file may be gone by the time that one looks at it.
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    paths.map(|path| 1 + walk(&path)).sum()
}

#[test]
fn killed_at_random_moments_it_comes_to_the_same_bytes() {
    for scene in KILLED {
        kill_and_resume(scene, 4, 1);
    }
}

/// `cargo test --release --test resume_command -- --ignored --nocapture`; SLICEFLOW_KILLS says how many of each scene, and
/// SLICEFLOW_SEED when.
#[test]
#[ignore = "takes minutes"]
fn killed_a_hundred_times_it_comes_to_the_same_bytes() {
    let number = |name: &str| -> Option<u64> { std::env::var(name).ok()?.parse().ok() };
    let kills = number("SLICEFLOW_KILLS").unwrap_or(25) as u32;
    for scene in KILLED {
        kill_and_resume(scene, kills, number("SLICEFLOW_SEED").unwrap_or(2));
        println!("{}: killed {kills} times, the same bytes", scene.0);
    }
}

/// From its first file on a run can be resumed, and before it nothing keeps the same command from running again.
#[test]
fn killed_as_soon_as_a_file_appears_it_can_go_on() {
    let place = Place::new();
    for round in 0..5 {
        let out = format!("run_{round}");
        let mut run = start(&mut place.run(&out, &[]));
        let is_whole = |entry: fs::DirEntry| {
            let name = entry.file_name().into_string().unwrap();
            !name.starts_with('.') && !name.ends_with(".part")
        };
        let has_file =
            || fs::read_dir(place.path(&out)).is_ok_and(|mut dir| dir.any(|e| is_whole(e.unwrap())));
        while !has_file() && run.try_wait().unwrap().is_none() {}
        assert!(has_file(), "it wrote nothing");
        run.kill().unwrap();
        run.wait().unwrap();
        place.told(&mut place.sliceflow(&["resume", &out, "--frames", "2"]), 0);
    }
}

#[test]
fn a_damaged_checkpoint_is_told_and_the_one_before_it_is_used() {
    let place = Place::new();
    place.told(
        &mut place.run("whole", &["--checkpoint-every", "5", "--keep-checkpoints", "3"]),
        0,
    );
    assert_eq!(
        place.checkpoints("whole"),
        [15, 20, 24].map(|frame| format!("checkpoint_{frame:06}.bin"))
    );
    let copy = Command::new("cp")
        .args(["-r", "whole", "run"])
        .current_dir(place.path(""))
        .status();
    assert!(copy.unwrap().success());
    // As if it had been killed behind the last frame: the manifest says that it runs.
    let manifest = place.path("run/run.json");
    let text = fs::read_to_string(&manifest).unwrap();
    fs::write(
        &manifest,
        text.replace(r#""status": "finished""#, r#""status": "running""#),
    )
    .unwrap();
    let newest = place.path("run/checkpoint_000024.bin");
    let mut bytes = fs::read(&newest).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(&newest, &bytes).unwrap();
    fs::write(place.path("run/checkpoint_000020.bin"), "").unwrap();
    fs::remove_file(place.path("run/frame_000018.png")).unwrap();
    fs::write(place.path("run/frame_000020.png.part"), "half").unwrap();

    let told = place.told(&mut place.sliceflow(&["resume", "run"]), 0);
    assert!(told.contains("checkpoint_000024.bin is damaged"), "{told}");
    assert!(told.contains("checkpoint_000020.bin is cut off"), "{told}");
    assert!(told.contains("after frame 15"), "{told}");
    assert!(told.contains("removed") && told.contains("made again"), "{told}");
    place.assert_same("whole", "run", "two damaged checkpoints");

    // Nothing is left to do.
    let told = place.told(&mut place.sliceflow(&["resume", "run"]), 0);
    assert!(told.contains("is finished"), "{told}");
    // Without any checkpoint it begins anew.
    for name in place.checkpoints("run") {
        fs::remove_file(place.path("run").join(name)).unwrap();
    }
    let text = fs::read_to_string(&manifest).unwrap();
    fs::write(
        &manifest,
        text.replace(r#""status": "finished""#, r#""status": "running""#),
    )
    .unwrap();
    let told = place.told(&mut place.sliceflow(&["resume", "run"]), 0);
    assert!(told.contains("beginning with frame 0"), "{told}");
    place.assert_same("whole", "run", "no checkpoint");
}

#[test]
fn a_stopped_run_goes_on_where_it_was_and_a_finished_one_grows() {
    let place = Place::new();
    let mut frames = FRAMES;
    // A machine may be so fast that the run ends before anybody stops it: then a longer one.
    loop {
        let mut run = start(&mut place.run("run", &["--frames", &frames.to_string()]));
        wait_for(&place.path("run/frame_000002.png"), &mut run);
        // Nobody else may write into it meanwhile.
        let meanwhile = place.sliceflow(&["resume", "run"]).output().unwrap();
        if run.try_wait().unwrap().is_none() {
            let told = String::from_utf8_lossy(&meanwhile.stderr);
            assert!(
                meanwhile.status.code() == Some(2) && told.contains("another run"),
                "{told}"
            );
            Command::new("kill")
                .args(["-INT", &run.id().to_string()])
                .status()
                .unwrap();
        }
        match run.wait().unwrap().code() {
            Some(130) => break,
            ended => assert_eq!(ended, Some(0)),
        }
        fs::remove_dir_all(place.path("run")).unwrap();
        frames *= 2;
    }
    let whole = frames.to_string();
    place.told(&mut place.run("whole", &["--frames", &whole]), 0);
    let done = place.manifest("run")["frames_done"].as_u64().unwrap();
    assert!(done < u64::from(frames), "{done}");
    assert_eq!(
        place.checkpoints("run"),
        [format!("checkpoint_{:06}.bin", done - 1)]
    );

    // Shorter first, then to the length that the whole run has.
    let told = place.told(&mut place.sliceflow(&["resume", "run", "--frames", "1"]), 2);
    assert!(told.contains("frames already"), "{told}");
    let middle = (done + 1).to_string();
    place.told(&mut place.sliceflow(&["resume", "run", "--frames", &middle]), 0);
    assert_eq!(place.manifest("run")["frames_done"], done + 1);
    place.told(&mut place.sliceflow(&["resume", "run", "--frames", &whole]), 0);
    place.assert_same("whole", "run", "stopped, short, long");
}

#[test]
fn a_variant_has_a_folder_of_its_own_and_goes_on_too() {
    let place = Place::new();
    let often = ["--checkpoint-every", "10", "--keep-checkpoints", "3"];
    place.told(&mut place.run("whole", &often), 0);
    let before = place.files("whole");
    // Frame 13 has no checkpoint.
    let told = place.told(&mut place.sliceflow(&["resume", "whole", "--branch-at", "13"]), 0);
    assert!(told.contains("frames 11 to 13"), "{told}");
    let mut same = place.files("whole_at_13");
    // Charts show what the folder has.
    same.retain(|name, _| !(name.starts_with("sensor") && name.ends_with(".png")));
    assert_eq!(same.len(), 12 * (1 + 6) + 3);
    for (name, bytes) in &same {
        let rows = bytes
            .iter()
            .position(|&byte| byte == b'\n')
            .map_or(0, |end| end + 1);
        match name.as_str() {
            "stats.jsonl" => assert!(before[name].ends_with(bytes), "statistics differ"),
            "sensors.csv" | "sensor_layers.csv" => {
                assert!(before[name].ends_with(&bytes[rows..]), "{name} differs");
            }
            _ => assert!(
                bytes == &before[name],
                "{name} differs though nothing was changed"
            ),
        }
    }

    let changed = [
        "resume",
        "whole",
        "--branch-at",
        "13",
        "--set",
        "events[0].set.gravity=[0,0]",
        "--out",
        "other",
    ];
    place.told(&mut place.sliceflow(&changed), 0);
    let other = place.files("other");
    let position = |frame: u32| format!("particles_{frame:06}/position.npy");
    assert_eq!(other[&position(13)], before[&position(13)]);
    assert_ne!(other[&position(14)], before[&position(14)]);
    assert!(place.files("whole") == before, "the first run is as it was");
    let manifest = place.manifest("other");
    assert_eq!(manifest["configuration"]["first_frame"], 13);
    assert_eq!(manifest["frames_done"], 12);

    let vain = [
        "resume",
        "whole",
        "--branch-at",
        "13",
        "--set",
        "gravity=[0,0]",
        "--frames",
        "15",
        "--out",
        "vain",
    ];
    let told = place.told(&mut place.sliceflow(&vain), 0);
    assert!(told.contains("--set 'events[0].set.gravity=[0.0,0.0]'"), "{told}");

    // A variant is killed at once, and goes on from its first checkpoint.
    let mut run =
        start(&mut place.sliceflow(&[&changed[..7], &["third", "--checkpoint-every", "0"]].concat()));
    wait_for(&place.path("third/frame_000014.png"), &mut run);
    run.kill().unwrap();
    run.wait().unwrap();
    assert_eq!(place.checkpoints("third"), ["checkpoint_000013.bin"]);
    place.told(&mut place.sliceflow(&["resume", "third"]), 0);
    place.assert_same("other", "third", "a variant that was killed");

    for (args, expected) in [
        (&["resume", "whole", "--branch-at", "25"][..], "no frame 25"),
        (&["resume", "other", "--branch-at", "12"], "--branch-at 13 to 24"),
        (
            &[
                "resume",
                "whole",
                "--branch-at",
                "3",
                "--set",
                "time.fps=100",
                "--out",
                "x",
            ],
            "another moment",
        ),
        (
            &["resume", "whole", "--branch-at", "3", "--out", "other"],
            "--force",
        ),
        (
            &[
                "resume",
                "whole",
                "--branch-at",
                "3",
                "--set",
                "gravty=1",
                "--out",
                "x",
            ],
            "gravity",
        ),
    ] {
        let told = place.told(&mut place.sliceflow(args), 2);
        assert!(told.contains(expected), "{args:?}: {told}");
        assert!(!place.path("x").exists(), "{args:?}");
    }
    let told = place.told(&mut place.sliceflow(&["resume", "nowhere"]), 1);
    assert!(told.contains("nowhere/run.json"), "{told}");
}

#[cfg(feature = "rerun")]
#[test]
fn recordings_of_what_comes_later_are_files_of_their_own() {
    let place = Place::new();
    place.told(
        &mut place.run("run", &["--frames", "4", "--rerun", "session.rrd"]),
        0,
    );
    let recorded = fs::read(place.path("session.rrd")).unwrap();
    let branch = ["resume", "run", "--branch-at", "2", "--out", "variant"];
    place.told(&mut place.sliceflow(&branch), 0);
    let told = place.told(&mut place.sliceflow(&["resume", "run", "--frames", "6"]), 0);
    assert!(told.contains("session_from_4.rrd"), "{told}");
    for name in ["variant/session_from_2.rrd", "session_from_4.rrd"] {
        assert!(place.path(name).exists(), "{name}");
    }
    assert!(fs::read(place.path("session.rrd")).unwrap() == recorded);

    // A run whose recording cannot be created leaves nothing that its next attempt would have to replace.
    let nowhere = ["--frames", "2", "--rerun", "scene.json/session.rrd"];
    place.told(&mut place.run("again", &nowhere), 1);
    place.told(&mut place.run("again", &nowhere[..2]), 0);
}
