//! Scenes, files and run folders that broke the program once. Each is answered with what is wrong and what helps, within
//! little memory; what is in `tests/attack/` stands there as it was found.

#![cfg(all(unix, feature = "cli"))]

#[path = "common/place.rs"]
mod place;

use std::fs;
use std::io::Write as _;
use std::os::unix::ffi::OsStrExt as _;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::Command;

use place::Place;
use sliceflow::output::{Checkpoint, Recorded};

/// The program within 4 GiB of address space and half a minute, without an adapter.
fn bounded(args: &[&str]) -> Command {
    let mut command = Command::new("sh");
    command
        .current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/attack"))
        .env("VK_DRIVER_FILES", "/nonexistent")
        .env("VK_ICD_FILENAMES", "/nonexistent")
        .args(["-c", "ulimit -v 4194304; exec timeout 30 \"$0\" \"$@\""])
        .arg(assert_cmd::cargo::cargo_bin!("sliceflow"))
        .args(args);
    command
}

/// The program in a folder.
fn plain(place: &Place, args: &[&str]) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("sliceflow"));
    command.current_dir(place.path("")).args(args);
    command
}

fn answer(command: &mut Command) -> (Option<i32>, String) {
    let output = command.output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.code(), told)
}

/// The program answers each with status 2, these words, and help.
fn refused(cases: &[(&[&str], &str)]) {
    let mut wrong = Vec::new();
    for (args, expected) in cases {
        let (status, told) = answer(&mut bounded(args));
        if status != Some(2) || !told.contains(expected) || !told.contains("help:") {
            wrong.push(format!(
                "{args:?}, status {status:?}, without \"{expected}\":\n{told}"
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn scenes_that_ask_for_too_much_are_refused_before_anything_is_made() {
    refused(&[
        (&["plan", "wide_box.json"], "would hold about 2.5e7 particles"),
        (&["plan", "fine_spacing.json"], "--max-memory"),
        (&["plan", "tall_box.json"], "would hold about 7840000 particles"),
        (&["plan", "far_drop.json"], "is too large"),
        (
            &["plan", "tall_domain.json"],
            "single precision rounds coordinates",
        ),
        (
            &["plan", "wide_emitters.json"],
            "its first layer reaches out of the domain",
        ),
        (&["plan", "endless_box.json"], "is too large"),
        (&["plan", "deep_box.json"], "z is 1e308 in a 2D scene"),
        (&["plan", "far_mesh.json"], "is too large"),
        (&["plan", "endless_drop.json"], "is too large"),
        (
            &["plan", "dam_break_2d", "--set", "fluid.spacing=1e-6"],
            "take about 1.2e7 boundary particles",
        ),
        (
            &[
                "plan",
                "dam_break_2d",
                "--set",
                r#"colliders=[{"shape":{"kind":"box","min":[0.6,0],"max":[1e60,1]}}]"#,
            ],
            "is too large",
        ),
        (
            &[
                "plan",
                "green_cube",
                "--set",
                r#"bodies=[{"shape":{"kind":"sphere","center":[1e60,0,0],"radius":0.1}}]"#,
            ],
            "is too large",
        ),
        (
            &[
                "plan",
                "dam_break_2d",
                "--set",
                r#"colliders=[{"shape":{"kind":"sphere","center":[0.7,0.5],"radius":1e6}}]"#,
            ],
            "boundary particles",
        ),
        (
            &[
                "plan",
                "harada_droplet",
                "--set",
                r#"colliders=[{"shape":{"kind":"sphere","center":[0.7,-0.5,0.5],"radius":1e6}}]"#,
            ],
            "boundary particles",
        ),
        (
            &[
                "plan",
                "harada_droplet",
                "--set",
                "fluid.spacing=0.02",
                "--set",
                "domain.max=[1e4,1,1e4]",
            ],
            "boundary particles",
        ),
        (
            &["plan", "taylor_couette", "--set", "bodies[0].shape.outer=1e6"],
            "would hold about",
        ),
        (
            &[
                "plan",
                "green_cube",
                "--set",
                r#"emitters=[{"name":"e","center":[0,0.5,0],"radius":1e6,"velocity":[0,-1,0]}]"#,
            ],
            "its first layer reaches out of the domain",
        ),
        (
            &[
                "plan",
                "column_2d",
                "--set",
                r#"emitters=[{"name":"e","center":[0.5,0.5],"radius":1e6,"velocity":[0,-1]}]"#,
            ],
            "its first layer reaches out of the domain",
        ),
        (
            &["plan", "lid_cavity", "--set", "bodies[0].shape.max=[1e5,0.1]"],
            "would hold about 2.5e7 particles",
        ),
        (
            &["plan", "small3d.json", "--set", "domain.max=[1e7,1,0.3]"],
            "single precision rounds coordinates",
        ),
        (
            &["plan", "small3d.json", "--max-particles", "50"],
            "at most 50 particles",
        ),
        (&["plan", "small3d.json", "--max-memory", "1kB"], "--max-memory"),
    ]);
}

#[test]
fn files_whose_headers_announce_too_much_are_refused() {
    let scene = |name: &str| format!("scene_of_{name}.json");
    let cases = [
        ("braces_npy", "header is not NumPy's"),
        ("shape_abort_npy", "the array is cut off"),
        ("shape_panic_npy", "larger than any memory"),
        ("shape_overflow2_npy", "larger than any memory"),
        ("components_abort_vtp", "components"),
        ("components_panic_vtp", "components"),
        ("points_panic_vtp", "announces more numbers than it holds"),
        ("zero_property_ply", "is more than its 72 bytes hold"),
    ];
    let cases = cases.map(|(name, expected)| (scene(name), expected));
    for (name, expected) in &cases {
        refused(&[(&["plan", name], expected)]);
    }
    let folder = tempfile::tempdir().unwrap();
    let put = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
    let mut bomb = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    bomb.write_all(b"BgeoV\0\0\0\x05\x7f\xff\xff\xff").unwrap();
    for _ in 0..200 {
        bomb.write_all(&[0; 1 << 20]).unwrap();
    }
    put("bomb.bgeo", &bomb.finish().unwrap());
    fs::copy("tests/attack/bomb.json", folder.path().join("bomb.json")).unwrap();
    let path = folder.path().join("bomb.json");
    refused(&[(&["plan", path.to_str().unwrap()], "unpack to more than")]);
    // The count of a binary STL.
    put("a.stl", &[[0; 80].as_slice(), &[0xff; 4], &[0; 100]].concat());
    put("pipe.json", mesh_scene("pipe.ply").as_bytes());
    put("zero.json", mesh_scene("zero.ply").as_bytes());
    put("stl.json", mesh_scene("a.stl").as_bytes());
    let pipe = folder.path().join("pipe.ply");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let at = |name: &str| folder.path().join(name).display().to_string();
    refused(&[
        (&["plan", &at("stl.json")], "is cut off"),
        (&["plan", &at("pipe.json")], "a pipe or a device"),
        (
            &[
                "plan",
                &at("zero.json"),
                "--set",
                "bodies[0].shape.file=/dev/zero.ply",
            ],
            "zero.ply",
        ),
    ]);
}

fn mesh_scene(file: &str) -> String {
    let scene = fs::read_to_string("tests/attack/scene_of_mtl_zero_obj.json").unwrap();
    scene.replace("mtl_zero.obj", file)
}

/// Materials of an OBJ are not used, so that whatever it names in their place is not opened: an endless device, say.
#[test]
fn materials_are_not_opened() {
    for scene in ["scene_of_mtl_zero_obj.json", "scene_of_mtl_passwd_obj.json"] {
        let (status, told) = answer(&mut bounded(&["plan", scene]));
        assert_eq!(status, Some(0), "{scene}: {told}");
    }
}

#[test]
fn scenes_read_files_of_their_own_folder_and_of_those_that_are_allowed() {
    let place = Place::new();
    fs::create_dir(place.path("inside")).unwrap();
    fs::copy("tests/attack/cube.obj", place.path("cube.obj")).unwrap();
    let scene = |name: &str, file: &str| fs::write(place.path(name), mesh_scene(file)).unwrap();
    scene("inside/up.json", "../cube.obj");
    scene("inside/linked.json", "link.obj");
    scene("inside/secret.json", "/etc/passwd.csv");
    symlink(place.path("cube.obj"), place.path("inside/link.obj")).unwrap();
    let absolute = place.path("cube.obj").display().to_string();
    scene("inside/absolute.json", &absolute);
    let plan = |args: &[&str]| answer(&mut plain(&place, &[&["plan"], args].concat()));
    for name in ["up", "linked", "absolute"] {
        let path = format!("inside/{name}.json");
        let (status, told) = plan(&[&path]);
        assert!(
            status == Some(2) && told.contains("outside of the scene's folder"),
            "{name}: {told}"
        );
        assert!(told.contains("--allow-read"), "{told}");
        let (status, told) = plan(&[&path, "--allow-read", "."]);
        assert_eq!(status, Some(0), "{name}: {told}");
    }
    // What the command line names is allowed.
    let set = format!("bodies[0].shape.file={absolute}");
    assert_eq!(plan(&["inside/secret.json", "--set", &set]).0, Some(0));
    assert_eq!(plan(&["bunny_pour"]).0, Some(0));
}

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

#[test]
fn odd_columns_and_ranges_are_refused_or_drawn() {
    let place = Place::new();
    place.told(&mut place.run("run", &["--frames", "1"]), 0);
    let position = place.path("run/particles_000000/position.npy");
    let array = |shape: &str, numbers: usize| {
        let mut header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}, }}");
        header += &" ".repeat((64 - (11 + header.len()) % 64) % 64);
        header.push('\n');
        let length = (header.len() as u16).to_le_bytes();
        [
            b"\x93NUMPY\x01\x00".as_slice(),
            &length,
            header.as_bytes(),
            &vec![0; 4 * numbers],
        ]
        .concat()
    };
    for (shape, numbers) in [("(5, 0)", 0), ("(5,)", 5), ("(5, 7)", 35), ("(5, 1, 2)", 10)] {
        fs::write(&position, array(shape, numbers)).unwrap();
        for args in [
            &["diff", "run", "run"][..],
            &["render", "run", "--set", "render.color.by=y"],
        ] {
            let output = plain(&place, args).output().unwrap();
            let told = String::from_utf8_lossy(&output.stderr);
            assert!(
                told.contains("help:") && !told.contains("panicked"),
                "{shape}, {args:?}: {told}"
            );
        }
    }
    let narrow = [
        "--frames",
        "1",
        "--no-statistics",
        "--set",
        "render.color.range=[0,5e-324]",
    ];
    place.told(&mut place.run("narrow", &narrow), 0);
}

#[cfg(feature = "surface")]
#[test]
fn surfaces_of_cubes_that_make_no_sense_are_refused() {
    let place = Place::new();
    let scene = fs::read_to_string("tests/attack/small3d.json").unwrap();
    fs::write(place.path("scene.json"), scene).unwrap();
    place.told(&mut place.run("run", &["--frames", "1", "--no-pictures"]), 0);
    for (size, expected) in [
        ("1e9", "larger than what the kernel reaches"),
        ("1e-9", "along one side"),
    ] {
        let (_, told) = answer(&mut plain(&place, &["surface", "run", "--cube-size", size]));
        assert!(told.contains(expected) && told.contains("help:"), "{told}");
    }
}

/// The program needs no folder for temporary files where a scene names no meshes.
#[test]
fn a_missing_folder_for_temporary_files_stops_no_scene_without_meshes() {
    let mut command = bounded(&["plan", "green_cube"]);
    let (status, told) = answer(command.env("TMPDIR", "/dev/null/folder"));
    assert_eq!(status, Some(0), "{told}");
    let (status, told) = answer(bounded(&["plan", "bunny_pour"]).env("TMPDIR", "/dev/null/folder"));
    assert!(status == Some(1) && told.contains("TMPDIR"), "{told}");
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

#[test]
fn every_case_is_used() {
    let text = include_str!("hostile.rs").to_owned() + include_str!("fuzz.rs");
    for entry in fs::read_dir(Path::new("tests/attack")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        let stem = name.trim_start_matches("scene_of_").trim_end_matches(".json");
        let scene = stem.replace('.', "_");
        assert!(
            text.contains(stem) || text.contains(&scene),
            "{name} is not tried"
        );
    }
}
