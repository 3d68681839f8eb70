//! What a run leaves behind besides frames: particle files, surfaces, videos; and imported scenes, as a user meets them.

#![cfg(all(feature = "surface", feature = "video"))]

use std::fs;
use std::path::{Path, PathBuf};

use assert_cmd::Command;
use image::AnimationDecoder as _;

use crate::command::sliceflow;

const SCENE_3D: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/common/scene_3d.json");

/// Standard error of a command that ends with this status.
fn told(command: &mut Command, status: i32) -> String {
    let assert = command.assert().code(status);
    String::from_utf8(assert.get_output().stderr.clone()).unwrap()
}

/// Four small frames of a 2D column.
fn short_run(out: &Path, more: &[&str]) -> Command {
    let mut command = sliceflow(&[
        "run",
        "column_2d",
        "--frames",
        "4",
        "--fps",
        "250",
        "--size",
        "64x48",
    ]);
    command.args(["--progress", "plain", "--out"]).arg(out).args(more);
    command
}

fn names(folder: &Path, prefix: &str) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> = entries
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    names.retain(|name| name.starts_with(prefix));
    names.sort();
    names
}

#[test]
fn particle_files_come_every_nth_frame_and_are_replaced_only_with_force() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let more = [
        "--no-pictures",
        "--particles",
        "ply,vtk,bgeo",
        "--particles-every",
        "3",
        "--columns",
        "id",
    ];
    short_run(&out, &more).assert().success();
    let files = |frame| ["bgeo", "ply", "vtp"].map(|ending| format!("particles_{frame:06}.{ending}"));
    let expected = [&["particles.pvd".to_owned()][..], &files(0), &files(3)].concat();
    assert_eq!(names(&out, "particles"), expected);
    let manifest = fs::read_to_string(out.join("run.json")).unwrap();
    for name in ["particles_NNNNNN.vtp", "particles.pvd", "position, id", "0, 3, 6"] {
        assert!(manifest.contains(name), "{name}");
    }

    assert!(told(&mut short_run(&out, &["--no-pictures"]), 2).contains("6 particle files"));
    short_run(&out, &["--no-pictures", "--force"]).assert().success();
    assert_eq!(names(&out, "particles"), [""; 0]);
}

#[test]
fn far_from_zero_single_precision_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let scene = fs::read_to_string(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/assets/scenes/column_2d.json"
    ))
    .unwrap();
    let mut scene: serde_json::Value = serde_json::from_str(&scene).unwrap();
    let shift = |point: &mut serde_json::Value| point[0] = (point[0].as_f64().unwrap() + 1e6).into();
    shift(&mut scene["domain"]["min"]);
    shift(&mut scene["domain"]["max"]);
    for body in scene["bodies"].as_array_mut().unwrap() {
        shift(&mut body["shape"]["min"]);
        shift(&mut body["shape"]["max"]);
    }
    let path = folder.path().join("far.json");
    fs::write(&path, scene.to_string()).unwrap();
    let run = |format: &str| {
        let mut command = sliceflow(&[
            "run",
            path.to_str().unwrap(),
            "--frames",
            "1",
            "--no-pictures",
            "--force",
        ]);
        command
            .args(["--particles", format, "--out"])
            .arg(folder.path().join("out"));
        told(&mut command, 0)
    };
    assert!(run("ply,bgeo").contains("ply and bgeo keep coordinates in single precision"));
    assert!(!run("vtk,npy").contains("single precision"));
}

#[test]
fn a_run_becomes_surfaces() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let mut run = sliceflow(&["run", SCENE_3D, "--frames", "3", "--fps", "100", "--no-pictures"]);
    run.args([
        "--allow-read",
        concat!(env!("CARGO_MANIFEST_DIR"), "/assets/meshes"),
    ]);
    run.args(["--particles", "bgeo", "--particles-every", "2", "--out"])
        .arg(&out);
    run.assert().success();

    let surface = |more: &[&str]| {
        let mut command = sliceflow(&["surface", out.to_str().unwrap()]);
        command.args(more);
        command
    };
    let text = told(&mut surface(&[]), 0);
    assert!(
        text.contains("2 of 3 frames") && text.contains("2 surfaces"),
        "{text}"
    );
    assert_eq!(
        names(&out, "surface"),
        ["surface_000000.ply", "surface_000002.ply"]
    );
    assert!(told(&mut surface(&[]), 2).contains("--force"));
    surface(&["--force", "--cube-size", "1"]).assert().success();
    let meshes = folder.path().join("meshes");
    surface(&[
        "--format",
        "obj",
        "--no-normals",
        "--out",
        meshes.to_str().unwrap(),
    ])
    .assert()
    .success();
    assert!(
        fs::read_to_string(meshes.join("surface_000002.obj"))
            .unwrap()
            .contains("\nf ")
    );
    assert!(told(&mut surface(&["--radius", "0"]), 2).contains("above zero"));
    let device = folder.path().join("device");
    let on_device = |more: &[&str]| {
        let mut command = surface(&["--on-device", "--out", device.to_str().unwrap()]);
        command.args(more);
        command
    };
    let text = told(&mut on_device(&[]), 0);
    assert!(
        text.contains("2 surfaces") && text.contains("voxels in memory"),
        "{text}"
    );
    assert_eq!(
        names(&device, "surface"),
        ["surface_000000.ply", "surface_000002.ply"]
    );
    assert!(told(&mut on_device(&["--smoothing", "10"]), 2).contains("--smoothing"));
    assert!(told(&mut on_device(&["--force", "--cube-size", "1e-6"]), 2).contains("--cube-size"));
    assert!(told(&mut surface(&["--grid", "rows"]), 2).contains("--on-device"));
}

#[test]
fn runs_without_a_surface_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let surface = |run: &Path| sliceflow(&["surface", run.to_str().unwrap()]);
    assert!(told(&mut surface(folder.path()), 1).contains("run.json"));
    let out = folder.path().join("out");
    short_run(&out, &["--no-pictures"]).assert().success();
    assert!(told(&mut surface(&out), 2).contains("--particles ply"));
    short_run(&out, &["--no-pictures", "--force", "--particles", "ply"])
        .assert()
        .success();
    assert!(told(&mut surface(&out), 2).contains("2D"));
}

#[test]
fn an_animation_needs_no_program() {
    let folder = tempfile::tempdir().unwrap();
    let gif = folder.path().join("movies/column.gif");
    let video = gif.to_str().unwrap();
    let none = folder.path().join("nothing");
    let run = |more: &[&str]| {
        let mut command = short_run(&folder.path().join("out"), &[&["--video", video], more].concat());
        command.env("PATH", &none);
        command
    };
    let text = told(&mut run(&["--no-pictures"]), 0);
    assert!(text.contains("every 2nd frame"), "{text}");
    let decoder =
        image::codecs::gif::GifDecoder::new(std::io::BufReader::new(fs::File::open(&gif).unwrap())).unwrap();
    assert_eq!(decoder.into_frames().count(), 2);
    assert_eq!(
        names(gif.parent().unwrap(), ""),
        ["column.gif"],
        "no partial file stays"
    );

    assert!(told(&mut run(&["--no-pictures"]), 2).contains("there already"));
    let mut missing = short_run(&folder.path().join("other"), &["--video", "a.mp4"]);
    let text = told(missing.env("PATH", &none), 2);
    assert!(text.contains("ffmpeg") && text.contains(".gif"), "{text}");
    assert!(!folder.path().join("other").exists(), "told before anything runs");
}

/// A folder with a program `ffmpeg`; its script gets the arguments of a video.
#[cfg(unix)]
fn stub(folder: &Path, script: &str) -> PathBuf {
    use std::os::unix::fs::PermissionsExt as _;
    let path = folder.join("programs");
    fs::create_dir_all(&path).unwrap();
    let program = path.join("ffmpeg");
    // The last argument is the file to write.
    let text = format!("#!/bin/sh\n[ \"$1\" = -version ] && exit 0\nfor out; do :; done\n{script}\n");
    fs::write(&program, text).unwrap();
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
    path
}

#[cfg(unix)]
fn with_programs<'a>(command: &'a mut Command, programs: &Path) -> &'a mut Command {
    let rest = std::env::var("PATH").unwrap_or_default();
    command.env("PATH", format!("{}:{rest}", programs.display()))
}

#[cfg(unix)]
#[test]
fn ffmpeg_gets_every_picture_in_order() {
    let folder = tempfile::tempdir().unwrap();
    let programs = stub(folder.path(), "echo \"$@\" > \"$out.args\"; cat > \"$out\"");
    let video = folder.path().join("movie.webm");
    let out = folder.path().join("out");
    let mut run = short_run(&out, &["--video", video.to_str().unwrap()]);
    with_programs(&mut run, &programs).assert().success();
    let raw = fs::read(&video).unwrap();
    let pictures: Vec<_> = raw.chunks(64 * 48 * 4).collect();
    assert_eq!(pictures.len(), 4);
    for (frame, bytes) in pictures.iter().enumerate() {
        let drawn = image::open(out.join(format!("frame_{frame:06}.png")))
            .unwrap()
            .into_rgba8();
        assert!(drawn.as_raw() == bytes, "frame {frame} is another picture");
    }
    let arguments = fs::read_to_string(folder.path().join("movie.part.webm.args")).unwrap();
    for wanted in [
        "-video_size 64x48",
        "-framerate 30",
        "libvpx-vp9",
        "-pix_fmt rgba",
    ] {
        assert!(arguments.contains(wanted), "{wanted}: {arguments}");
    }
}

#[cfg(unix)]
#[test]
fn frames_outlive_an_ffmpeg_that_dies() {
    let folder = tempfile::tempdir().unwrap();
    let programs = stub(
        folder.path(),
        "head -c 12288 > \"$out\"; echo 'no room for the encoder' >&2; exit 7",
    );
    let video = folder.path().join("movie.mp4");
    let out = folder.path().join("out");
    let mut run = short_run(&out, &["--video", video.to_str().unwrap()]);
    let text = told(with_programs(&mut run, &programs), 1);
    for wanted in ["no room for the encoder", "exit status: 7", "frame_%06d.png"] {
        assert!(text.contains(wanted), "{wanted}: {text}");
    }
    assert_eq!(names(&out, "frame_").len(), 4);
    assert_eq!(names(folder.path(), "movie"), [""; 0], "half a video is no video");
    let manifest = fs::read_to_string(out.join("run.json")).unwrap();
    assert!(manifest.contains("\"failed\"") && manifest.contains("no room for the encoder"));
}

#[test]
fn a_peers_scene_is_imported_and_runs() {
    let folder = tempfile::tempdir().unwrap();
    let peer = folder.path().join("peer.json");
    fs::write(
        &peer,
        r#"{
            "Configuration": { "particleRadius": 0.1, "maxError": 0.05 },
            "FluidBlocks": [ { "start": [-0.5, 0, -0.5], "end": [0.5, 1, 0.5] } ]
        }"#,
    )
    .unwrap();
    let scene = folder.path().join("mine.json");
    let import = |more: &[&str]| {
        let mut command = sliceflow(&["import", peer.to_str().unwrap()]);
        command.args(more);
        command
    };
    let to_file = ["--out", scene.to_str().unwrap()];
    let text = told(&mut import(&to_file), 0);
    for wanted in [
        "ignored: Configuration.maxError",
        "becomes a fluid of the solver `dfsph`",
        "imported 64 particles",
    ] {
        assert!(text.contains(wanted), "{wanted}: {text}");
    }
    assert!(told(&mut import(&to_file), 2).contains("--force"));
    let set = ["--set", "fluid.viscosity=5"];
    let changed = import(&set).assert().success().get_output().stdout.clone();
    assert!(String::from_utf8_lossy(&changed).contains("\"viscosity\": 5"));
    let printed = import(&[]).assert().success().get_output().stdout.clone();
    assert_eq!(fs::read(&scene).unwrap(), printed);

    // What changes the physics comes first, and a strict import refuses it.
    let elastic = fs::read_to_string(&peer).unwrap().replacen(
        '{',
        r#"{ "Materials": [ { "id": "Fluid", "elasticityMethod": 3, "colorMapType": 7 } ],"#,
        1,
    );
    fs::write(&peer, elastic).unwrap();
    let text = told(&mut import(&[]), 0);
    assert!(
        text.starts_with("warning: the physics change: Materials[0].elasticityMethod: it is elastic there"),
        "{text}"
    );
    let refused = told(&mut import(&["--strict"]), 2);
    assert!(
        refused.contains("elasticityMethod") && !refused.contains("colorMapType"),
        "{refused}"
    );

    let mut run = sliceflow(&[
        "run",
        scene.to_str().unwrap(),
        "--frames",
        "3",
        "--size",
        "64x48",
        "--out",
    ]);
    run.arg(folder.path().join("out")).assert().success();
}
