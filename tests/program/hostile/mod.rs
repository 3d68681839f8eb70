//! Scenes, files and run folders that broke the program once. Each is answered with what is wrong and what helps, within
//! little memory; what is in `tests/attack/` stands there as it was found.

#![cfg(unix)]

mod folders;
mod scenes;

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::place::Place;

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

fn mesh_scene(file: &str) -> String {
    let scene = fs::read_to_string("tests/attack/scene_of_mtl_zero_obj.json").unwrap();
    scene.replace("mtl_zero.obj", file)
}

#[test]
fn every_case_is_used() {
    let text = [
        include_str!("scenes.rs"),
        include_str!("folders.rs"),
        include_str!("../../fuzz.rs"),
    ]
    .concat();
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
