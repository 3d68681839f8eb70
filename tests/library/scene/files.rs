//! Files: scenes that ship, meshes, particles.

use std::path::Path;

use glam::{DVec3, Vec3};
use serde_json::Value;
use sliceflow::scene::{check, library, load};

use super::{block, valid};

#[test]
fn scenes_that_ship_load() {
    let entries = library::entries().unwrap_or_else(|error| panic!("{error}"));
    for (name, particles) in [
        ("column_2d", 2_000),
        ("harada_figure_2", 65_536),
        ("harada_figure_2_small", 8_192),
    ] {
        let entry = entries.iter().find(|entry| entry.name == name).expect(name);
        assert_eq!(entry.particles, particles, "{name}");
    }
    let green = load::load(Path::new("green_cube"), &[]).unwrap();
    assert_eq!(green.particles.len(), 65_536);
    assert!(green.capacity > 65_536);
    for entry in entries {
        assert!(
            !entry.description.is_empty() && !entry.source.is_empty(),
            "{}",
            entry.name
        );
        let scene = load::load(Path::new(&entry.name), &[]).unwrap();
        assert_eq!(scene.notes, [""; 0], "{}", entry.name);
        let value: Value = serde_json::from_str(library::find(&entry.name).unwrap()).unwrap();
        assert_eq!(check::check(&value, &load::schema()), [], "{}", entry.name);
    }
}

#[test]
fn a_file_wins_over_a_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("green_cube");
    std::fs::write(&path, block().to_string()).unwrap();
    assert_eq!(load::load(&path, &[]).unwrap().particles.len(), 64);
}

#[test]
fn meshes_that_ship_are_unpacked_beside_the_scenes() {
    let folder = library::folder().unwrap();
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/meshes");
    let mut count = 0;
    for entry in shipped.read_dir().unwrap() {
        let path = entry.unwrap().path();
        let unpacked = folder.join("../meshes").join(path.file_name().unwrap());
        assert_eq!(std::fs::read(&unpacked).unwrap(), std::fs::read(&path).unwrap());
        count += 1;
    }
    assert!(count > 0);
}

#[test]
fn a_filled_in_scene_is_a_valid_scene() {
    let scene = valid(&block(), &[]);
    let again = serde_json::to_value(&scene.file).unwrap();
    assert_eq!(valid(&again, &[]).particles, scene.particles);
}

#[test]
fn defaults_hold_when_a_group_is_left_out() {
    let scene = valid(&block(), &[]);
    assert_eq!(scene.neighbors.slots, 4);
    assert_eq!(scene.name, "test");
    assert_eq!(scene.gravity, Vec3::new(0.0, -9.81, 0.0));
}

#[test]
fn bodies_come_from_particle_files_and_meshes() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(
        folder.path().join("points.csv"),
        "x,y,z,vx,vy,vz,id\n0.5,0.5,0.5,1,2,3,1\n0.2,0.3,0.4,0,0,0,0\n",
    )
    .expect("a file");
    let mesh = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/meshes/bunny.obj");
    let text = format!(
        r#"{{
          "domain": {{ "min": [0, 0, 0], "max": [2, 1, 1] }},
          "grains": {{ "radius": 0.02, "spring": 1000, "restitution": 0.5 }},
          "bodies": [
            {{ "shape": {{ "kind": "particles", "file": "points.csv" }}, "velocity": [0, 1, 0] }},
            {{ "shape": {{ "kind": "mesh", "file": "{}", "placement": {{ "scale": 0.6, "translate": [1.4, 0.1, 0.5] }} }} }}
          ]
        }}"#,
        mesh.display()
    );
    let scene = load::parse(&text, "files.json", folder.path(), &[]).unwrap_or_else(|e| panic!("{e}"));
    let position = |i: usize| scene.particles.position[i].as_dvec3() + scene.origin;
    // In order of the file's ids; velocities of body and file add up.
    assert!(position(0).distance(DVec3::new(0.2, 0.3, 0.4)) < 1e-6);
    assert!(position(1).distance(DVec3::new(0.5, 0.5, 0.5)) < 1e-6);
    assert_eq!(scene.particles.velocity[1], Vec3::new(1.0, 3.0, 3.0));
    let filled = scene.particles.len() - 2;
    assert!((400..600).contains(&filled), "{filled}");
    assert!((2..scene.particles.len()).all(|i| position(i).x > 1.0));
}

#[test]
fn particles_of_a_file_may_press_against_walls_as_in_the_run_they_come_from() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = |height: f64| {
        std::fs::write(
            folder.path().join("bed.csv"),
            format!("x,y,z\n0.5,{height},0.5\n"),
        )
        .expect("a file");
        let text = r#"{
          "domain": { "min": [0, 0, 0], "max": [1, 1, 1] },
          "grains": { "radius": 0.1, "spring": 1000, "restitution": 0.5 },
          "bodies": [ { "shape": { "kind": "particles", "file": "bed.csv" } } ]
        }"#;
        load::parse(text, "bed.json", folder.path(), &[]).map_err(|error| error.to_string())
    };
    assert_eq!(scene(0.085).map(|scene| scene.particles.len()), Ok(1));
    let error = scene(0.07).expect_err("too deep");
    assert!(
        error.contains("reaches through the domain's side y_min, by 0.03 m"),
        "{error}"
    );
}
