//! Arguments, run folders and checkpoints.

use std::fs;
use std::os::unix::ffi::OsStrExt as _;
use std::os::unix::fs::symlink;

use sliceflow::output::{Checkpoint, Recorded};

use super::{answer, plain};
use crate::place::Place;

#[test]
fn arguments_that_are_no_text_are_refused() {
    let place = Place::new();
    let mut command = plain(&place, &["run", "scene.json", "--frames", "1", "--out"]);
    let (status, told) = answer(command.arg(std::ffi::OsStr::from_bytes(b"o\xff")));
    assert!(status == Some(2) && told.contains("is not UTF-8 text"), "{told}");
}

#[test]
fn control_characters_do_not_reach_the_terminal() {
    let place = Place::new();
    let (_, told) = answer(&mut plain(&place, &["plan", "a\u{1b}[31mred\u{9b}31m"]));
    assert!(told.contains(r"a\u{1b}[31mred\u{9b}31m"), "{told}");
    let output = plain(&place, &["plan", "scene.json", "--set", "name=a\u{1b}[2J"])
        .output()
        .unwrap();
    assert!(output.status.success() && !output.stdout.contains(&0x1b));
}

/// A finished run, whose folder then gets links in place of its files.
#[test]
fn links_in_a_run_folder_lead_nowhere() {
    let place = Place::new();
    place.told(
        &mut place.run("run", &["--frames", "3", "--checkpoint-every", "1"]),
        0,
    );
    let outside = place.path("outside");
    fs::create_dir(&outside).unwrap();
    fs::write(outside.join("id.npy"), "kept").unwrap();
    fs::write(outside.join("file"), "kept").unwrap();
    let set_running = || {
        let text = fs::read_to_string(place.path("run/run.json")).unwrap();
        let text = text.replace(r#""status": "finished""#, r#""status": "running""#);
        fs::write(place.path("run/run.json"), text).unwrap();
    };
    let ways = [
        ("particles_000002", "outside"),
        ("particles_000001", "outside"),
        ("stats.jsonl", "outside/file"),
        ("sensors.csv", "outside/file"),
        ("run.json.part", "outside/file"),
        ("frame_000002.png.part", "outside/file"),
        ("checkpoint_000003.bin.part", "outside/file"),
        (".sliceflow", "outside/file"),
    ];
    set_running();
    for (name, target) in ways {
        let (path, aside) = (place.path("run").join(name), place.path("aside"));
        let was_there = path.exists();
        if was_there {
            fs::rename(&path, &aside).unwrap();
        }
        symlink(place.path(target), &path).unwrap();
        for args in [
            &["resume", "run", "--frames", "5"][..],
            &["run", "scene.json", "--frames", "2", "--out", "run", "--force"],
        ] {
            let told = place.told(&mut place.sliceflow(args), 2);
            assert!(
                told.contains(name) && told.contains("a link to another place"),
                "{args:?}: {told}"
            );
        }
        fs::remove_file(&path).unwrap();
        if was_there {
            fs::rename(&aside, &path).unwrap();
        }
        assert_eq!(
            fs::read_to_string(outside.join("file")).unwrap(),
            "kept",
            "{name}"
        );
        assert!(outside.join("id.npy").exists(), "{name}");
    }
}

#[test]
fn frames_that_are_gone_are_told() {
    let place = Place::new();
    place.told(&mut place.run("run", &["--frames", "3"]), 0);
    fs::remove_file(place.path("run/frame_000001.png")).unwrap();
    fs::remove_dir_all(place.path("run/particles_000000")).unwrap();
    for frames in ["3", "4"] {
        let told = place.told(&mut place.sliceflow(&["resume", "run", "--frames", frames]), 0);
        assert!(
            told.contains("2 files of frames") && told.contains("particles_000000"),
            "{told}"
        );
    }
}

/// Arguments that a stranger has recorded do not replace files outside of the run's folder.
#[test]
fn recorded_arguments_replace_nothing_outside() {
    let place = Place::new();
    place.told(
        &mut place.run("run", &["--frames", "2", "--checkpoint-every", "0"]),
        0,
    );
    let path = place.path("run/run.json");
    let mut manifest = place.manifest("run");
    manifest["status"] = "running".into();
    let arguments = manifest["configuration"]["arguments"].as_array_mut().unwrap();
    arguments.extend(["--video".into(), "mine.png".into()]);
    fs::write(&path, manifest.to_string()).unwrap();
    fs::write(place.path("mine.png"), "mine").unwrap();
    let told = place.told(&mut place.sliceflow(&["resume", "run"]), 2);
    assert!(
        told.contains("outside of the run's folder") && told.contains("--force"),
        "{told}"
    );
    assert_eq!(fs::read_to_string(place.path("mine.png")).unwrap(), "mine");
    place.told(&mut place.sliceflow(&["resume", "run", "--force"]), 0);
    assert_ne!(fs::read(place.path("mine.png")).unwrap(), b"mine");
}

#[test]
fn force_removes_what_runs_have_recorded_and_nothing_else() {
    let place = Place::new();
    let run = |more: &[&str]| place.run("run", &[&["--frames", "2"], more].concat());
    place.told(&mut run(&[]), 0);
    let mine = [
        "frame_000123.png",
        "surface_000001.obj",
        "particles_000001/mine.npy",
        "checkpoint_000900.bin",
    ];
    for name in mine {
        fs::write(place.path("run").join(name), "mine").unwrap();
    }
    let told = place.told(&mut run(&["--force", "--no-pictures"]), 0);
    assert!(
        told.contains("4 files stay") && told.contains("removed an earlier run"),
        "{told}"
    );
    assert!(!place.path("run/frame_000001.png").exists());
    for name in mine {
        assert_eq!(
            fs::read_to_string(place.path("run").join(name)).unwrap(),
            "mine",
            "{name}"
        );
    }
    // What the next run would write over is refused.
    fs::write(place.path("run/frame_000001.png"), "mine").unwrap();
    let told = place.told(&mut run(&["--force"]), 2);
    assert!(told.contains("frame_000001.png would be replaced"), "{told}");
}

#[test]
fn one_video_is_made_by_one_run() {
    let place = Place::new();
    // As another run holds it.
    let partial = fs::File::create(place.path("mix.part.gif")).unwrap();
    partial.lock().unwrap();
    let video = ["--frames", "2", "--video", "mix.gif"];
    let told = place.told(&mut place.run("one", &video), 2);
    assert!(told.contains("another run is making mix.gif"), "{told}");
    drop(partial);
    place.told(&mut place.run("one", &video), 0);
    assert!(place.path("mix.gif").exists() && !place.path("mix.part.gif").exists());
}

/// A checkpoint may be changed and have its checksum right.
#[test]
fn forged_checkpoints_are_told_and_passed_over() {
    let place = Place::new();
    place.told(
        &mut place.run("run", &["--frames", "3", "--checkpoint-every", "2"]),
        0,
    );
    let name = place.checkpoints("run").pop().unwrap();
    let path = place.path("run").join(&name);
    let whole = fs::read(&path).unwrap();
    let recorded = Recorded::read(&place.path("run")).unwrap();
    let scene = recorded.configuration().unwrap().scene(&[]).unwrap();
    assert_eq!(Checkpoint::read(&path).unwrap().state.check(&scene), Ok(()));
    for (what, forge) in FORGERIES {
        fs::write(&path, forged(&whole, *forge)).unwrap();
        let is_sound = |read: &Checkpoint| {
            read.state.frame == 2 && read.state.is_finite() && read.state.check(&scene).is_ok()
        };
        assert!(
            !Checkpoint::read(&path).is_ok_and(|read| is_sound(&read)),
            "{what}"
        );
    }
    // The last one is still there.
    let text = fs::read_to_string(place.path("run/run.json")).unwrap();
    fs::write(
        place.path("run/run.json"),
        text.replace(r#""status": "finished""#, r#""status": "running""#),
    )
    .unwrap();
    let told = place.told(&mut place.sliceflow(&["resume", "run"]), 0);
    assert!(
        told.contains(&name) && told.contains("looking for one before it"),
        "{told}"
    );
}

type Forge = fn(&mut serde_json::Value, &mut Vec<Vec<u8>>);

/// What is changed of the header, and of the buffers behind it.
const FORGERIES: &[(&str, Forge)] = &[
    ("particles", |header, _| {
        header["particles"] = 4_000_000_000u32.into()
    }),
    ("dimensions", |header, _| header["dimensions"] = 3.into()),
    ("frame", |header, _| header["frame"] = u32::MAX.into()),
    ("short buffer", |header, buffers| {
        header["buffers"][0][1] = 7.into();
        buffers[0].truncate(7);
    }),
    ("short clock", |header, buffers| {
        let clock = place_of(header, "clock");
        header["buffers"][clock][1] = 1.into();
        buffers[clock].truncate(1);
    }),
    ("axis", |header, buffers| {
        let grid = place_of(header, "grid");
        buffers[grid].fill(0xff);
    }),
    ("ids", |header, buffers| {
        let ids = place_of(header, "id");
        buffers[ids].fill(0xff);
    }),
    ("positions", |header, buffers| {
        let positions = place_of(header, "position");
        buffers[positions].fill(0xff);
    }),
];

fn place_of(header: &serde_json::Value, name: &str) -> usize {
    let buffers = header["buffers"].as_array().unwrap();
    buffers.iter().position(|buffer| buffer[0] == name).unwrap()
}

/// A checkpoint with another header and other buffers, and the checksum that belongs to them.
fn forged(whole: &[u8], forge: Forge) -> Vec<u8> {
    use sha2::Digest as _;

    let magic = whole.iter().position(|&byte| byte == b'\n').unwrap() + 1;
    let (length, rest) = whole[magic..whole.len() - 32].split_at(8);
    let length = u64::from_le_bytes(length.try_into().unwrap()) as usize;
    let mut header: serde_json::Value = serde_json::from_slice(&rest[..length]).unwrap();
    let mut rest = &rest[length..];
    let mut buffers = Vec::new();
    for buffer in header["buffers"].as_array().unwrap() {
        let (bytes, behind) = rest.split_at(buffer[1].as_u64().unwrap() as usize);
        buffers.push(bytes.to_vec());
        rest = behind;
    }
    forge(&mut header, &mut buffers);
    let header = serde_json::to_vec(&header).unwrap();
    let mut file = [
        &whole[..magic],
        &(header.len() as u64).to_le_bytes(),
        &header,
        &buffers.concat(),
    ]
    .concat();
    let checksum = sha2::Sha256::digest(&file);
    file.extend_from_slice(&checksum);
    file
}
