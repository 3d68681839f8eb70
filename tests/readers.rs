//! Files that runs write, opened by the programs and libraries that people use for them.
//!
//! Those are Python packages (tests/readers/requirements.txt) in the target folder, where `./sliceflow test` installs
//! them.

#![cfg(feature = "cli")]

use std::path::{Path, PathBuf};
use std::process::Command;

/// Runs a script of tests/readers; returns what it prints.
fn python(script: &str, arguments: &[&str]) -> String {
    let python = Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("python/bin/python");
    assert!(
        python.exists(),
        "the readers are not installed in {}\n  help: ./sliceflow test --test readers installs them",
        python.display()
    );
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let output = Command::new(python)
        .arg(root.join("tests/readers").join(script))
        .args(arguments)
        .output()
        .unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    assert!(
        output.status.success(),
        "{}{}",
        text(&output.stdout),
        text(&output.stderr)
    );
    text(&output.stdout)
}

/// Runs a scene; returns the folder of the run.
fn run(scene: &str, folder: &Path, more: &[&str]) -> PathBuf {
    let out = folder.join("out");
    let mut command = assert_cmd::cargo::cargo_bin_cmd!("sliceflow");
    command
        .args(["run", scene, "--no-pictures", "--progress", "plain", "--out"])
        .arg(&out)
        .args(more)
        .assert()
        .success();
    out
}

const SCENE_3D: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/common/scene_3d.json");

#[cfg(feature = "surface")]
const SCENE_FLUID: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/common/fluid_3d.json");

#[test]
fn particle_files_are_what_the_arrays_say() {
    let meshes = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/meshes");
    let all = [
        "--particles",
        "ply,vtk,bgeo,npy",
        "--frames",
        "5",
        "--fps",
        "250",
        "--allow-read",
        meshes,
    ];
    for (scene, every, frames) in [
        ("column_2d", "2", &["0", "2", "4"][..]),
        (SCENE_3D, "4", &["0", "4"]),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let out = run(
            scene,
            folder.path(),
            &[&all[..], &["--particles-every", every]].concat(),
        );
        let out = out.to_str().unwrap();
        let told = python("particles.py", &[&[out, "250"], frames].concat());
        assert_eq!(told.trim(), format!("{} frames agree", frames.len()));
    }
}

/// What artists' programs open: surfaces as glTF, and everything as USD, with value clips and in one file.
#[cfg(feature = "surface")]
#[test]
fn surfaces_and_usd_are_what_the_arrays_say() {
    let folder = tempfile::tempdir().unwrap();
    let more = [
        "--particles",
        "npy",
        "--frames",
        "3",
        "--fps",
        "50",
        "--particles-every",
        "2",
    ];
    let out = run(SCENE_FLUID, folder.path(), &more);
    let place = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (run, glbs, clips, one_file) = (out.to_str().unwrap(), place("glb"), place("clips"), place("one"));
    for arguments in [
        &["surface", run][..],
        &["surface", run, "--format", "glb", "--out", &glbs],
        &["usd", run, "--out", &clips],
        &["usd", run, "--one-file", "--out", &one_file],
    ] {
        let mut command = assert_cmd::cargo::cargo_bin_cmd!("sliceflow");
        command.args(arguments).assert().success();
    }
    let told = python("artists.py", &[run, &glbs, &clips, &one_file, "50", "0", "2"]);
    assert!(told.starts_with("2 frames agree"), "{told}");
}

/// What compositors open.
#[test]
fn extra_images_are_what_the_arrays_say() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let passes = "color,depth,normal,id,velocity,motion";
    let meshes = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/meshes");
    let mut command = assert_cmd::cargo::cargo_bin_cmd!("sliceflow");
    command
        .args([
            "run",
            SCENE_3D,
            "--frames",
            "2",
            "--particles",
            "npy",
            "--size",
            "160x90",
        ])
        .args([
            "--passes",
            passes,
            "--allow-read",
            meshes,
            "--progress",
            "plain",
            "--out",
        ])
        .arg(&out)
        .args(["--set", "render.background=transparent"])
        .assert()
        .success();
    let told = python("images.py", &[out.to_str().unwrap(), "0", "1"]);
    assert_eq!(told.trim(), "2 frames agree");
}
