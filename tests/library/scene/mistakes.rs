//! Mistakes and their messages, and `--set`.

use std::path::Path;

use glam::Vec3;
use sliceflow::error::Error;
use sliceflow::scene::load;

use super::{block, message, valid};

#[test]
fn broken_scenes_are_explained() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/broken_scenes");
    let mut files: Vec<_> = folder
        .read_dir()
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    files.sort();
    assert!(files.len() >= 10);
    for file in files {
        let name = file.file_name().unwrap().to_str().unwrap();
        let text = std::fs::read_to_string(&file).unwrap();
        let error = load::parse(&text, name, &folder, &[]).expect_err(name);
        insta::assert_snapshot!(file.file_stem().unwrap().to_str().unwrap(), error);
    }
}

#[test]
fn an_unknown_name_suggests_the_nearest() {
    let error = load::load(Path::new("gren_cube"), &[]).unwrap_err();
    assert!(matches!(error, Error::Usage { .. }));
    assert!(
        error.to_string().contains("did you mean `green_cube`?"),
        "{error}"
    );
}

// --set

#[test]
fn set_changes_values_on_any_level() {
    let scene = valid(
        &block(),
        &[
            "time.fps=60",
            "bodies[0].velocity=[0,1,0]",
            "render.splat=disc",
            "name=my scene",
            "bodies[0].shape.max[1]=0.2",
        ],
    );
    assert_eq!(scene.time.fps, 60.0);
    assert_eq!(scene.particles.velocity[0], Vec3::Y);
    assert_eq!(serde_json::to_value(scene.render.splat).unwrap(), "disc");
    assert_eq!(scene.name, "my scene");
    assert_eq!(scene.particles.len(), 32);
}

#[test]
fn set_explains_what_it_cannot_do() {
    let broken = [
        "bodies[3].velocity=[0,1,0]",
        "colliders[0].color=#ffffff",
        "grains.radius.max=1",
        "grains",
        "bodies[x]=1",
        ".=1",
    ];
    insta::assert_snapshot!("set_broken_paths", message(&block(), &broken));
    let unknown = ["grains.radus=1", "time.fps=fast", "grains.spring=NaN"];
    insta::assert_snapshot!("set_unknown_keys", message(&block(), &unknown));
}
