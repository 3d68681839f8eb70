use std::path::PathBuf;

use glam::Vec3;
use serde_json::json;

use super::*;
use crate::scene::ColliderShape;
use crate::scene::mesh::samples::cube;
use crate::scene::model::FluidSolver;

/// A folder with the meshes `box.obj` (a cube of side 1), `wedge.obj` (half of it) and a scene.
fn folder(scene: &Value) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let put = |name: &str, text: String| std::fs::write(folder.path().join(name), text).unwrap();
    let half = glam::DVec3::splat(0.5);
    let mesh = cube(-half, half);
    let mut text: String = mesh
        .vertices
        .iter()
        .map(|v| format!("v {} {} {}\n", v.x, v.y, v.z))
        .collect();
    for [a, b, c] in &mesh.triangles {
        text += &format!("f {} {} {}\n", a + 1, b + 1, c + 1);
    }
    put("box.obj", text);
    put(
        "wedge.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n".into(),
    );
    let path = folder.path().join("scene.json");
    std::fs::write(&path, scene.to_string()).unwrap();
    (folder, path)
}

/// A block of fluid in a box, as the peer's dam breaks are.
fn dam() -> Value {
    json!({
        "Configuration": {
            "particleRadius": 0.025, "gravitation": [0, -9.81, 0], "timeStepSize": 0.005, "stopAt": 2.0,
            "cameraPosition": [0, 2, 8], "cameraLookat": [0, 1, 0], "DFSPH": { "maxError": 0.05, "maxErrorV": 0.1 }
        },
        "Materials": [ { "id": "Fluid", "density0": 900, "viscosityMethod": 1, "renderMaxValue": 4, "colorMapType": 1 } ],
        "RigidBodies": [
            { "geometryFile": "box.obj", "translation": [0, 1.5, 0], "rotationAxis": [1, 0, 0], "rotationAngle": 0,
              "scale": [4, 3, 1.5], "color": [0.1, 0.4, 0.6, 1.0], "isWall": true, "mapInvert": true,
              "mapResolution": [40, 30, 15] },
            { "geometryFile": "wedge.obj", "translation": [1, 0, 0], "scale": [0.5, 1, 0.25],
              "rotationAxis": [0, 0, 2], "rotationAngle": std::f64::consts::FRAC_PI_2, "isDynamic": true }
        ],
        "FluidBlocks": [
            { "start": [-0.5, 0, -0.5], "end": [0.5, 1, 0.5], "translation": [-1.45, 0.05, 0], "scale": [1, 1, 1],
              "initialVelocity": [0.5, 0, 0] }
        ],
        "AnimationFields": []
    })
}

fn ignored(imported: &Imported) -> Vec<String> {
    imported
        .ignored
        .iter()
        .map(|ignored| ignored.path.clone())
        .collect()
}

#[test]
fn a_cubic_metre_gives_as_many_particles_as_there() {
    let (folder, path) = folder(&dam());
    let imported = import(&path, Some(folder.path())).unwrap();
    let scene = &imported.scene;
    assert_eq!(scene.particles.len(), 19 * 19 * 19);
    // The peer's first and last particle stand a spacing inside the block's corners.
    let global = |p: &Vec3| p.as_dvec3() + scene.origin;
    let low = scene
        .particles
        .position
        .iter()
        .map(global)
        .fold(glam::DVec3::INFINITY, glam::DVec3::min);
    let high = scene
        .particles
        .position
        .iter()
        .map(global)
        .fold(glam::DVec3::NEG_INFINITY, glam::DVec3::max);
    assert!(low.distance(glam::DVec3::new(-1.9, 0.1, -0.45)) < 1e-5, "{low}");
    assert!(high.distance(glam::DVec3::new(-1.0, 1.0, 0.45)) < 1e-5, "{high}");
    assert!(
        scene
            .particles
            .velocity
            .iter()
            .all(|v| *v == Vec3::new(0.5, 0.0, 0.0))
    );
    assert_eq!(scene.radius(), 0.025);
    assert_eq!(scene.file.density(), 900.0);
    assert_eq!(scene.file.time.duration, 2.0);
    assert_eq!(scene.file.render.camera.eye, Some([0.0, 2.0, 8.0]));
    assert_eq!(scene.file.render.color.range, Some([0.0, 4.0]));
    let fluid = scene.fluid().unwrap();
    assert_eq!((fluid.spacing, fluid.materials.len()), (0.05, 1));
    assert_eq!(
        (fluid.solver, fluid.max_density_error, fluid.max_divergence_error),
        (FluidSolver::Dfsph, 0.0005, 0.001)
    );
    assert!(imported.notes.iter().any(|note| note.contains("solver `dfsph`")));
}

#[test]
fn the_box_around_the_fluid_is_the_domain_and_other_bodies_stand_where_they_did() {
    let (folder, path) = folder(&dam());
    let scene = import(&path, Some(folder.path())).unwrap().scene;
    assert_eq!(scene.file.domain.min.0, [-2.0, 0.0, -0.75]);
    assert_eq!(scene.file.domain.max.0, [2.0, 3.0, 0.75]);
    let [collider] = &scene.colliders[..] else {
        panic!("{:?}", scene.colliders)
    };
    let ColliderShape::Mesh(mesh) = &collider.shape else {
        panic!("{:?}", collider.shape)
    };
    // Scaled to 0.5 × 1 × 0.25, then a quarter turn about z: x becomes y, y becomes -x.
    let mut corners: Vec<_> = mesh
        .vertices
        .iter()
        .map(|v| ((*v + scene.origin) * 1000.0).round().to_array())
        .collect();
    corners.sort_by(|a, b| a.partial_cmp(b).unwrap());
    let expected = [
        [0.0, 0.0, 0.0],
        [1000.0, 0.0, 0.0],
        [1000.0, 0.0, 250.0],
        [1000.0, 500.0, 0.0],
    ];
    assert_eq!(corners, expected);
}

#[test]
fn the_solver_follows_the_peers() {
    for (method, solver) in [
        (0, FluidSolver::Wcsph),
        (3, FluidSolver::Dfsph),
        (4, FluidSolver::Dfsph),
    ] {
        let mut scene = dam();
        scene["Configuration"]["simulationMethod"] = method.into();
        let (folder, path) = folder(&scene);
        let imported = import(&path, Some(folder.path())).unwrap();
        assert_eq!(imported.scene.fluid().unwrap().solver, solver, "{method}");
        // What the peer's other solvers stop at says nothing about this one.
        let has_effect = !ignored(&imported)
            .iter()
            .any(|path| path == "Configuration.DFSPH");
        assert_eq!(has_effect, method == 4, "{method}");
    }
}

#[test]
fn what_has_no_effect_is_listed_by_its_place() {
    let (folder, path) = folder(&dam());
    let imported = import(&path, Some(folder.path())).unwrap();
    let mut found = ignored(&imported);
    found.sort();
    assert_eq!(
        found,
        [
            "AnimationFields",
            "Configuration.timeStepSize",
            "Materials[0].viscosityMethod",
            "RigidBodies[0].mapResolution",
            "RigidBodies[1].isDynamic",
        ]
    );
}

#[test]
fn models_are_filled_from_meshes_and_particle_files() {
    let mut scene = dam();
    scene["FluidBlocks"] = json!([]);
    scene["FluidModels"] = json!([
        { "particleFile": "box.obj", "translation": [1, 1, 0], "scale": 0.5, "id": "Fluid" },
        { "particleFile": "points.csv", "translation": [-1, 1, 0], "rotationAxis": [0, 1, 0],
          "rotationAngle": std::f64::consts::PI, "scale": [2, 2, 2] }
    ]);
    scene["RigidBodies"].as_array_mut().unwrap().truncate(1);
    let (folder, path) = folder(&scene);
    std::fs::write(
        folder.path().join("points.csv"),
        "x,y,z\n0.1,0.2,0.1\n0.3,0.2,0.1\n",
    )
    .unwrap();
    let imported = import(&path, Some(folder.path())).unwrap();
    let scene = imported.scene;
    assert_eq!(scene.particles.len(), 10 * 10 * 10 + 2);
    let last = scene.particles.position[1001].as_dvec3() + scene.origin;
    assert!(last.distance(glam::DVec3::new(-1.6, 1.4, -0.2)) < 1e-6, "{last}");

    let mut open = dam();
    open["FluidBlocks"] = json!([]);
    open["RigidBodies"] = json!([]);
    open["FluidModels"] = json!([{ "particleFile": "box.obj", "translation": [9, 9, 9] }]);
    std::fs::write(&path, open.to_string()).unwrap();
    let scene = import(&path, Some(folder.path())).unwrap().scene;
    assert_eq!(scene.particles.len(), 20 * 20 * 20, "the open domain holds it");
}

#[test]
fn several_fluids_keep_their_materials() {
    let mut scene = dam();
    scene["Materials"].as_array_mut().unwrap().extend([
        json!({ "id": "Oil", "density0": 800 }),
        json!({ "id": "Absent", "density0": 1 }),
    ]);
    let mut oil = scene["FluidBlocks"][0].clone();
    oil["id"] = "Oil".into();
    oil["translation"] = json!([0.5, 0.05, 0]);
    scene["FluidBlocks"].as_array_mut().unwrap().push(oil);
    let (folder, path) = folder(&scene);
    let imported = import(&path, Some(folder.path())).unwrap();
    let scene = &imported.scene;
    let densities: Vec<f64> = scene
        .fluid()
        .unwrap()
        .materials
        .iter()
        .map(|m| m.density)
        .collect();
    assert_eq!(densities, [900.0, 800.0]);
    let each = 19 * 19 * 19;
    assert!(scene.particles.material[..each].iter().all(|&m| m == 0));
    let rest = &scene.particles.material[each..];
    assert!(rest.len() > each / 2 && rest.iter().all(|&m| m == 1));
    assert!(ignored(&imported).contains(&"Materials[2]".to_owned()));
}

#[test]
fn flat_scenes_stay_flat() {
    let mut scene = dam();
    scene["Configuration"]["sim2D"] = true.into();
    let (folder, path) = folder(&scene);
    let imported = import(&path, Some(folder.path())).unwrap();
    assert_eq!(imported.scene.particles.len(), 19 * 19);
    assert_eq!(imported.scene.file.domain.max.0, [2.0, 3.0]);
    assert!(ignored(&imported).contains(&"RigidBodies[1]".to_owned()));
}

#[test]
fn without_a_box_the_domain_is_open() {
    let mut scene = dam();
    scene["RigidBodies"] = json!([]);
    let (folder, path) = folder(&scene);
    let imported = import(&path, Some(folder.path())).unwrap();
    assert!(
        imported.notes.iter().any(|note| note.contains("open")),
        "{:?}",
        imported.notes
    );
    assert_eq!(imported.scene.particles.len(), 19 * 19 * 19);
}

#[test]
fn mistakes_are_told_with_their_place() {
    let mut scene = dam();
    scene["FluidBlocks"][0]["start"] = json!([0, 1]);
    let (_folder, path) = folder(&scene);
    let message = import(&path, None).unwrap_err().to_string();
    assert!(
        message.contains("FluidBlocks[0].start") && message.contains("three numbers"),
        "{message}"
    );

    let mut scene = dam();
    scene["RigidBodies"][0]["geometryFile"] = "absent.obj".into();
    let (_folder, path) = self::folder(&scene);
    let message = import(&path, None).unwrap_err().to_string();
    assert!(
        message.contains("absent.obj") && message.contains("RigidBodies[0]"),
        "{message}"
    );
}

#[test]
fn a_scene_of_emitters_alone_says_what_was_ignored_and_that_nothing_is_left() {
    let mut scene = dam();
    scene.as_object_mut().unwrap().remove("FluidBlocks");
    scene["Emitters"] = json!([{ "width": 5, "height": 5, "translation": [0, 1, 0], "velocity": 2 }]);
    let (_folder, path) = folder(&scene);
    let message = import(&path, None).unwrap_err().to_string();
    for wanted in [
        "comes from Emitters",
        "no particles remain",
        "ignored: Emitters",
        "FluidBlocks",
    ] {
        assert!(message.contains(wanted), "{wanted}: {message}");
    }
}

#[test]
fn files_are_named_from_where_the_scene_stands() {
    let relative =
        |file: &str, folder: &str| relative(Path::new(file), Path::new(folder)).display().to_string();
    assert_eq!(relative("/a/b/m.obj", "/a/b"), "m.obj");
    assert_eq!(
        relative("/a/models/m.obj", "/a/scenes/mine"),
        "../../models/m.obj"
    );
}
