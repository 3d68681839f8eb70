//! From nothing to a first scene: what ships, what begins one, what its keys mean, and what a mistake is told.

use std::fs;
use std::path::Path;

use crate::command::{failure, output, sliceflow};

/// Standard error of a command that the user has to correct.
fn refused(args: &[&str]) -> String {
    failure(args, 2)
}

#[test]
fn a_scene_that_ships_is_printed_to_the_letter() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/scenes/dam_break_2d.json");
    assert_eq!(
        output(&["scenes", "dam_break_2d"]),
        fs::read_to_string(file).unwrap()
    );
    assert!(refused(&["scenes", "dam_break"]).contains("`dam_break_2d`"));
    let note = sliceflow(&["scenes", "bunny_pour"]).assert().success();
    let note = String::from_utf8_lossy(&note.get_output().stderr).into_owned();
    assert!(
        note.contains("bunny.obj") && note.contains("new NAME --from bunny_pour"),
        "{note}"
    );
}

#[test]
fn new_scenes_have_comments_and_can_be_planned() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    for (name, more, dimensions) in [
        ("dam", &[][..], "2D"),
        ("deep/dam", &["--dimensions", "3"], "3D"),
        ("heap", &["--kind", "grains"], "2D"),
        ("block.jsonc", &["--kind", "grains", "--dimensions", "3"], "3D"),
    ] {
        let file = if name.contains('.') {
            path(name)
        } else {
            path(name) + ".json"
        };
        let told = output(&[&["new", &path(name)], more].concat());
        assert_eq!(told.trim(), file);
        assert!(fs::read_to_string(&file).unwrap().contains("// "), "{name}");
        let plan = output(&["plan", &file]);
        assert!(plan.contains(dimensions), "{name}: {plan}");
        assert!(!plan.contains("note:"), "{name}: {plan}");
    }
    // `--frames` counts with the scene's own frames a second, comments or not.
    let plan = output(&["plan", &path("dam.json"), "--frames", "7"]);
    assert!(plan.contains("frames     7 at 30"), "{plan}");

    fs::write(path("dam.json"), "mine").unwrap();
    let told = refused(&["new", &path("dam")]);
    assert!(
        told.contains("there already") && told.contains("--force"),
        "{told}"
    );
    assert_eq!(fs::read_to_string(path("dam.json")).unwrap(), "mine");
    output(&["new", &path("dam"), "--force"]);
    assert!(fs::read_to_string(path("dam.json")).unwrap().contains("// "));
}

#[test]
fn a_scene_that_ships_is_begun_with_together_with_its_mesh() {
    let folder = tempfile::tempdir().unwrap();
    let mine = folder.path().join("mine.json").display().to_string();
    let told = output(&["new", &mine, "--from", "bunny_pour"]);
    assert_eq!(told.lines().count(), 2, "{told}");
    assert!(folder.path().join("bunny.obj").exists());
    let plan = output(&["plan", &mine, "--set", "grains.radius=0.05"]);
    assert!(plan.contains("scene      mine, 3D"), "{plan}");
    // A second scene reads the same mesh.
    let other = folder.path().join("other.json").display().to_string();
    output(&["new", &other, "--from", "bunny_shower"]);
    assert!(refused(&["new", &other, "--from", "no_scene"]).contains("no_scene"));
}

#[test]
fn keys_are_explained() {
    let viscosity = output(&["schema", "fluid.viscosity"]);
    for part in [
        "a number from 0 to",
        "0 when left out",
        "Dynamic viscosity, Pa·s.",
    ] {
        assert!(viscosity.contains(part), "{viscosity}");
    }
    let shape = output(&["schema", "bodies[0].shape"]);
    assert!(
        shape.contains("cylinder") && shape.contains("center, radius"),
        "{shape}"
    );
    assert!(output(&["schema", "grains.dashpot"]).contains("Its normal part only"));
    // The last part of a path will do.
    let angle = output(&["schema", "field_of_view"]);
    assert!(angle.starts_with("render.camera.field_of_view: "), "{angle}");
    let several = output(&["schema", "viscosity"]);
    assert!(
        several.contains("fluid.viscosity") && several.contains("fluid.materials[].viscosity"),
        "{several}"
    );
    for (typed, meant) in [
        ("lookat", "`render.camera.target`"),
        ("fluid.viscosty", "`fluid.viscosity`"),
        ("cylinder", "`cylinder` is a value of `bodies.shape`"),
        ("cube", "`box` is a value of `bodies.shape` or `colliders.shape`"),
        ("dt", "`time.step`"),
        ("nonsense", "the outermost keys are"),
    ] {
        let told = refused(&["schema", typed]);
        assert!(told.contains(meant), "{typed}: {told}");
    }
}

#[test]
fn words_of_other_programs_are_understood() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("scene.json");
    let text = r##"{
      "domain": { "boxMin": [0, 0, 0], "max": [1, 1, 1] },
      "fluid": { "particleRadius": 0.025, "restDensity": 1000 },
      "bodies": [
        { "shape": { "kind": "cube", "min": [0, 0, 0], "max": [0.5, 0.5, 0.5] } },
        { "shape": { "kind": "sphere", "position": [0.7, 0.7, 0.7], "radius": 0.1 } }
      ],
      "fps": 60,
      "render": { "camera": { "position": [2, 1, 2], "lookat": [0, 0, 0], "fov": 40 } }
    }"##;
    fs::write(&file, text).unwrap();
    let told = refused(&["plan", file.to_str().unwrap()]);
    for (place, meant) in [
        ("domain.boxMin", "`min`"),
        (
            "fluid.particleRadius",
            "`spacing`? It is the distance of particles",
        ),
        ("fluid.restDensity", "`density`"),
        ("bodies[0].shape.kind", "`box`"),
        ("bodies[1].shape.position", "`center`"),
        ("fps", "`time.fps`"),
        ("render.camera.position", "`eye`"),
        ("render.camera.lookat", "`target`"),
        ("render.camera.fov", "`field_of_view`"),
    ] {
        let line = told
            .lines()
            .skip_while(|line| !line.trim_start().starts_with(&format!("{place}: ")));
        let help = line.take(2).collect::<String>();
        assert!(help.contains(&format!("did you mean {meant}")), "{place}: {told}");
    }
    let told = refused(&["plan", "column_2d", "--set", "render.color.by=velocity"]);
    assert!(told.contains("`speed`"), "{told}");
}

/// Lines on standard error that are no warning.
fn told(args: &[&str], out: &Path) -> Vec<String> {
    let run = [
        "run",
        "column_2d",
        "--frames",
        "2",
        "--fps",
        "1000",
        "--size",
        "64x48",
        "-o",
    ];
    let mut command = sliceflow(&run);
    let assert = command.arg(out).args(args).assert().success();
    let told = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
    let lines = told.lines().filter(|line| !line.starts_with("warning:"));
    lines.map(str::to_owned).collect()
}

#[test]
fn quiet_runs_tell_warnings_alone() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    assert!(told(&["--progress", "plain"], &out).len() > 2);
    assert_eq!(told(&["-q", "--force"], &out), [""; 0]);
    assert_eq!(told(&["--progress", "none", "--force"], &out), [""; 0]);
    assert!(out.join("frame_000001.png").exists());
}

#[test]
fn shells_complete_commands() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = output(&["completions", shell]);
        for word in ["inspect", "--checkpoint-every"] {
            assert!(
                script.contains(word) || script.contains(word.trim_start_matches('-')),
                "{shell}: {word}"
            );
        }
    }
    assert!(refused(&["completions", "csh"]).contains("bash"));
}
