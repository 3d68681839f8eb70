use std::path::PathBuf;

use glam::{DVec3, Vec3};
use serde_json::json;

use super::*;
use crate::scene::ColliderShape;
use crate::scene::mesh::samples::cube;
use crate::scene::model::{FluidSolver, Slip};

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
            "Configuration.timeStepSize",
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
    // What lies across the plane does not matter.
    scene["FluidBlocks"][0]["start"][2] = json!(-5.0);
    scene["RigidBodies"][0]["mapInvert"] = false.into();
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
fn emitters_flow_where_and_when_they_did() {
    let mut scene = dam();
    scene.as_object_mut().unwrap().remove("FluidBlocks");
    scene["Emitters"] = json!([
        { "type": 1, "width": 6, "translation": [0, 1, 0], "velocity": 2, "emitStartTime": 0.5, "emitEndTime": 1.0,
          "rotationAxis": [0, 0, 1], "rotationAngle": -std::f64::consts::FRAC_PI_2 },
        { "width": 8, "height": 3, "translation": [-1, 2, 0], "velocity": 1, "emitEndTime": 9 },
    ]);
    let (folder, path) = folder(&scene);
    let imported = import(&path, Some(folder.path())).unwrap();
    let [round, wide] = &imported.scene.file.emitters[..] else {
        panic!("{}", imported.json)
    };
    // As wide as six particles, and down.
    assert!((round.radius - 0.15).abs() < 1e-9, "{}", round.radius);
    let down = DVec3::from_slice(&round.velocity.0);
    assert!(down.distance(DVec3::new(0.0, -2.0, 0.0)) < 1e-9, "{down}");
    let area = std::f64::consts::PI * wide.radius * wide.radius;
    assert!((area - 8.0 * 3.0 * 0.05 * 0.05).abs() < 1e-9, "{area} m²");
    assert_eq!((round.on, wide.on), (false, true));
    // The run ends before the second one does.
    let switches = imported.json["events"].as_array().unwrap();
    let times: Vec<_> = switches
        .iter()
        .map(|event| event["at"].as_f64().unwrap())
        .collect();
    assert_eq!(times, [0.5, 1.0]);
    let warned = imported.ignored.iter().filter(|ignored| ignored.changes_physics);
    let warned: Vec<_> = warned.map(|ignored| ignored.path.as_str()).collect();
    assert_eq!(warned, ["RigidBodies[1].isDynamic", "Emitters[1].type"]);
}

/// Coefficients of three of the peer's methods are kinematic viscosities; those of the others have no unit.
#[test]
fn viscosity_is_that_of_the_peer() {
    let scene = |materials: Value| {
        let mut scene = dam();
        scene["Materials"] = materials;
        let (folder, path) = folder(&scene);
        import(&path, Some(folder.path())).unwrap()
    };
    let honey = scene(json!([{ "id": "Fluid", "density0": 1400, "viscosityMethod": 6,
        "Weiler et al. 2018": { "viscosity": 0.5, "viscosityBoundary": 0.4, "viscoMaxIter": 9 } }]));
    let fluid = honey.scene.fluid().unwrap();
    assert_eq!(fluid.materials[0].viscosity, 700.0);
    assert!(fluid.implicit_viscosity && fluid.slip == Slip::NoSlip);
    assert!(
        !honey
            .ignored
            .iter()
            .any(|ignored| ignored.path.starts_with("Materials") && ignored.changes_physics)
    );
    let water = scene(json!([{ "id": "Fluid", "density0": 1000, "viscosityMethod": 1,
        "Standard viscosity": { "viscosity": 0.01, "viscosityBoundary": 0 } }]));
    let fluid = water.scene.fluid().unwrap();
    assert_eq!((fluid.materials[0].viscosity, fluid.slip), (10.0, Slip::FreeSlip));
    let peer =
        scene(json!([{ "id": "Fluid", "viscosityMethod": 4, "elasticityMethod": 0, "dragMethod": 2 }]));
    assert_eq!(peer.scene.fluid().unwrap().materials[0].viscosity, 1e-3);
    let lost: Vec<_> = peer
        .ignored
        .iter()
        .filter(|ignored| ignored.changes_physics)
        .collect();
    let paths: Vec<_> = lost.iter().map(|lost| lost.path.as_str()).collect();
    for path in ["Materials[0].viscosityMethod", "Materials[0].dragMethod"] {
        assert!(paths.contains(&path), "{paths:?}");
    }
    assert!(!paths.contains(&"Materials[0].elasticityMethod"));
    // They stand before all else.
    assert!(
        peer.ignored[..lost.len()]
            .iter()
            .all(|ignored| ignored.changes_physics)
    );
}

#[test]
fn steps_are_as_long_as_the_peers() {
    let scene = |configuration: Value| {
        let mut scene = dam();
        for (key, value) in configuration.as_object().unwrap() {
            scene["Configuration"][key] = value.clone();
        }
        let (folder, path) = folder(&scene);
        import(&path, Some(folder.path())).unwrap().scene
    };
    let follows = scene(json!({ "cflMethod": 1, "cflFactor": 0.5, "cflMaxTimeStepSize": 0.002 }));
    let fluid = follows.fluid().unwrap();
    assert_eq!((fluid.courant_number, follows.file.time.step), (0.2, Some(0.002)));
    let fixed = scene(json!({ "cflMethod": 0, "timeStepSize": 0.001, "gravitation": [0, 0, 0] }));
    assert_eq!(fixed.file.time.step, Some(0.001));
    let floating = scene(json!({ "gravitation": [0, 0, 0] }));
    assert!(floating.fluid().unwrap().max_speed > 0.0);
}

#[test]
fn keys_can_be_changed() {
    let (folder, path) = folder(&dam());
    let overrides = ["fluid.viscosity=7", "time.duration=0.5"].map(str::to_owned);
    let imported = import_within(&path, Some(folder.path()), &overrides, &Allowance::default()).unwrap();
    assert_eq!(imported.scene.fluid().unwrap().materials[0].viscosity, 7.0);
    assert_eq!(imported.json["time"]["duration"], 0.5);
    let wrong = import_within(&path, None, &["fluid".to_owned()], &Allowance::default());
    assert!(wrong.unwrap_err().to_string().contains("no `=`"));
}

#[test]
fn a_scene_without_fluid_says_what_was_ignored_and_that_nothing_is_left() {
    let mut scene = dam();
    scene.as_object_mut().unwrap().remove("FluidBlocks");
    let (_folder, path) = folder(&scene);
    let message = import(&path, None).unwrap_err().to_string();
    for wanted in ["no particles remain", "ignored: RigidBodies", "FluidBlocks"] {
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
