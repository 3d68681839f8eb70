//! What sensors measure, against what is known.

use std::path::Path;

use glam::DVec3;
use sliceflow::output::columns_named;
use sliceflow::plan::{Phase, Plan, Wanted};
use sliceflow::scene::{Scene, load};
use sliceflow::simulation::{Frame, Sample, Values};

use crate::common;

fn scene(text: &str, overrides: &[&str]) -> Scene {
    let overrides: Vec<String> = overrides.iter().map(|&o| o.to_owned()).collect();
    match load::parse(text, "test.json", Path::new("."), &overrides) {
        Ok(scene) => scene,
        Err(error) => panic!("{error}"),
    }
}

/// All frames of a scene, with positions and velocities.
fn frames(scene: &Scene) -> Vec<Frame> {
    let wanted = Wanted {
        columns: columns_named(["position", "velocity"]).expect("columns"),
        sensors: true,
        ..Wanted::default()
    };
    let mut simulation = common::simulate(scene, &wanted);
    let mut frames = Vec::new();
    while simulation.next_index() < scene.time.frames {
        frames.extend(simulation.next_frame().expect("a frame"));
    }
    while let Some(frame) = simulation.finish_frame().expect("a frame") {
        frames.push(frame);
    }
    frames
}

/// The values of the sensor of this name.
fn of<'a>(scene: &Scene, sample: &'a Sample, name: &str) -> &'a [f64] {
    let place = scene.sensors.list.iter().position(|sensor| sensor.name == name);
    &sample.values[place.expect("a sensor of this name")]
}

fn assert_near(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{what}: {found} instead of {expected} ± {tolerance}"
    );
}

/// A tank of water at rest: 0.4 m wide, 0.3 m deep, in 3D 0.3 m broad.
fn still_water(dimensions: usize) -> &'static str {
    match dimensions {
        2 => {
            r#"{
  "dimensions": 2, "domain": { "min": [0, 0], "max": [0.4, 0.5] }, "gravity": [0, -9.81],
  "fluid": { "solver": "wcsph", "spacing": 0.01 },
  "bodies": [{ "shape": { "kind": "box", "min": [0, 0], "max": [0.4, 0.3] }, "pressure": "hydrostatic" }],
  "sensors": [
    { "name": "deep", "kind": "point", "at": [0.2, 0.1] },
    { "name": "wall", "kind": "point", "at": [0, 0.2] },
    { "name": "corner", "kind": "point", "at": [0.4, 0] },
    { "name": "air", "kind": "point", "at": [0.2, 0.45] },
    { "name": "air_velocity", "kind": "point", "at": [0.2, 0.45], "field": "velocity" },
    { "name": "middle", "kind": "height", "from": [0.2, 0] },
    { "name": "rim", "kind": "height", "from": [0, 0] },
    { "name": "dry", "kind": "height", "from": [0.2, 0.35] },
    { "name": "floor", "kind": "force", "side": "y_min" },
    { "name": "left", "kind": "force", "side": "x_min", "about": [0, 0] },
    { "name": "pressures", "kind": "profile", "axis": "y", "layers": 3, "field": "pressure", "max": [0.4, 0.3] },
    { "name": "water", "kind": "extremes", "field": "position" },
    { "name": "nothing", "kind": "extremes", "field": "speed", "min": [0.1, 0.4] }
  ],
  "time": { "duration": 0.001, "fps": 1000 }
}"#
        }
        _ => {
            r#"{
  "dimensions": 3, "domain": { "min": [0, 0, 0], "max": [0.4, 0.5, 0.3] }, "gravity": [0, -9.81, 0],
  "fluid": { "solver": "wcsph", "spacing": 0.025 },
  "bodies": [{ "shape": { "kind": "box", "min": [0, 0, 0], "max": [0.4, 0.3, 0.3] }, "pressure": "hydrostatic" }],
  "sensors": [
    { "name": "deep", "kind": "point", "at": [0.2, 0.1, 0.15] },
    { "name": "wall", "kind": "point", "at": [0, 0.2, 0.15] },
    { "name": "corner", "kind": "point", "at": [0.4, 0, 0] },
    { "name": "air", "kind": "point", "at": [0.2, 0.45, 0.15] },
    { "name": "air_velocity", "kind": "point", "at": [0.2, 0.45, 0.15], "field": "velocity" },
    { "name": "middle", "kind": "height", "from": [0.2, 0, 0.15] },
    { "name": "rim", "kind": "height", "from": [0, 0, 0] },
    { "name": "dry", "kind": "height", "from": [0.2, 0.35, 0.15] },
    { "name": "floor", "kind": "force", "side": "y_min" },
    { "name": "left", "kind": "force", "side": "x_min", "about": [0, 0, 0.15] },
    { "name": "pressures", "kind": "profile", "axis": "y", "layers": 3, "field": "pressure", "max": [0.4, 0.3, 0.3] },
    { "name": "water", "kind": "extremes", "field": "position" },
    { "name": "nothing", "kind": "extremes", "field": "speed", "min": [0.1, 0.4, 0] }
  ],
  "time": { "duration": 0.001, "fps": 1000 }
}"#
        }
    }
}

#[test]
fn water_at_rest_has_its_pressures_and_weighs_on_the_floor() {
    for dimensions in [2, 3] {
        let scene = scene(still_water(dimensions), &[]);
        let frames = frames(&scene);
        let first = &frames[0].samples[0];
        assert_eq!(
            (first.time, first.step, frames[0].samples.len()),
            (0.0, Some(0), 1)
        );
        let value = |name: &str| of(&scene, first, name);
        let weight = 1000.0 * 9.81; // of a cubic metre, N
        let spacing = 2.0 * scene.radius();
        let tolerance = 0.02 * 0.3 * weight;
        for (name, depth) in [("deep", 0.2), ("wall", 0.1), ("corner", 0.3)] {
            assert_near(value(name)[0], depth * weight, tolerance, name);
        }
        assert_eq!(value("air"), [0.0]);
        assert!(value("air_velocity").iter().all(|v| v.is_nan()));
        assert_eq!(value("air_velocity").len(), dimensions);
        for name in ["middle", "rim"] {
            assert_near(value(name)[0], 0.3, 0.15 * spacing, name);
        }
        assert_eq!(value("dry"), [0.0]);

        let depth = if dimensions == 2 { 1.0 } else { 0.3 };
        let floor = value("floor");
        let water = 0.4 * 0.3 * depth * weight;
        // The lattice is not quite at rest at first.
        assert_near(floor[1], -water, 0.06 * water, "force on the floor");
        assert_near(floor[0], 0.0, 1e-3 * water, "force along the floor");
        // The side is pushed away from the water, a third of the depth above the floor.
        let left = value("left");
        let push = 0.5 * 0.3 * 0.3 * depth * weight;
        assert_near(left[0], -push, 0.06 * push, "force on a side");
        let torque = left[left.len() - 1];
        assert_near(torque, push * 0.1, 0.08 * push * 0.1, "torque on a side");

        let pressures = value("pressures");
        for (layer, found) in pressures.chunks(2).enumerate() {
            let depth = 0.25 - 0.1 * layer as f64;
            assert_near(found[0], depth * weight, tolerance, "mean pressure of a layer");
            assert_eq!(
                found[1],
                f64::from(scene.first_boundary()) / 3.0,
                "particles of a layer"
            );
        }
        let water = value("water");
        assert_near(water[0], 0.5 * spacing, 1e-3 * spacing, "leftmost particle");
        assert_near(
            water[dimensions],
            0.4 - 0.5 * spacing,
            1e-3 * spacing,
            "rightmost particle",
        );
        assert_eq!(water[2 * dimensions], f64::from(scene.first_boundary()));
        let nothing = value("nothing");
        assert!(nothing[0].is_nan() && nothing[1].is_nan() && nothing[2] == 0.0);
    }
}

const STREAM: &str = r#"{
  "dimensions": 3, "domain": { "min": [0, 0, 0], "max": [0.8, 0.4, 0.4], "walls": "periodic" }, "gravity": [0, 0, 0],
  "fluid": { "solver": "wcsph", "spacing": 0.04, "max_speed": 1 },
  "bodies": [{ "shape": { "kind": "box", "min": [0, 0, 0], "max": [0.8, 0.4, 0.4] }, "velocity": [0.5, -0.25, 0.125] }],
  "sensors": [
    { "name": "inside", "kind": "point", "at": [0.41, 0.17, 0.22], "field": "velocity" },
    { "name": "border", "kind": "point", "at": [0, 0.4, 0], "field": "speed" },
    { "name": "density", "kind": "point", "at": [0.1, 0.1, 0.1], "field": "density" },
    { "name": "through", "kind": "flux", "min": [0.33, 0, 0], "max": [0.33, 0.4, 0.4] },
    { "name": "window", "kind": "flux", "min": [0, 0.2, 0], "max": [0.4, 0.2, 0.2] },
    { "name": "edge", "kind": "flux", "min": [0.8, 0, 0], "max": [0.8, 0.4, 0.4] },
    { "name": "profile", "kind": "profile", "axis": "x", "layers": 4 },
    { "name": "fastest", "kind": "extremes", "field": "speed" }
  ],
  "time": { "duration": 0.02, "fps": 50 }
}"#;

#[test]
fn a_uniform_stream_is_seen_as_such() {
    let scene = scene(STREAM, &[]);
    for frame in frames(&scene) {
        let sample = &frame.samples[0];
        let value = |name: &str| of(&scene, sample, name);
        for (found, expected) in value("inside").iter().zip([0.5, -0.25, 0.125]) {
            assert_near(*found, expected, 1e-5, "velocity");
        }
        let speed = DVec3::new(0.5, -0.25, 0.125).length();
        assert_near(value("border")[0], speed, 1e-5, "speed on the border");
        assert_near(value("fastest")[1], speed, 1e-5, "fastest");
        assert_near(value("density")[0], 1000.0, 1.0, "density");
        let area = 0.4 * 0.4;
        for name in ["through", "edge"] {
            assert_near(value(name)[0], 0.5 * area, 1e-5, name);
            assert_near(value(name)[1], 500.0 * area, 1e-2, name);
        }
        // Its border cuts a row of particles somewhere.
        assert_near(value("window")[0], -0.25 * 0.4 * 0.2, 0.25 * 0.04 * 0.4, "window");
        for layer in value("profile").chunks(4) {
            assert_near(layer[0], 0.5, 1e-5, "mean velocity");
            assert_near(layer[2], 0.125, 1e-5, "mean velocity");
        }
        let particles: f64 = value("profile").chunks(4).map(|layer| layer[3]).sum();
        assert_eq!(particles, f64::from(scene.first_boundary()));
    }
}

/// Momentum of all particles of `mass`, kg·m/s.
fn momentum(frame: &Frame, mass: f64) -> DVec3 {
    let velocity = frame.columns.iter().find(|column| column.name == "velocity");
    let Some(Values::Vector { columns, values }) = velocity.map(|column| &column.values) else {
        panic!("velocities are vectors");
    };
    let vector = |v: &[f32]| DVec3::new(v[0].into(), v[1].into(), v.get(2).map_or(0.0, |&z| z.into()));
    values.chunks_exact(*columns).map(vector).sum::<DVec3>() * mass
}

const SPLASH: &str = r#"{
  "dimensions": 2, "domain": { "min": [0, 0], "max": [0.6, 0.5] }, "gravity": [1, -9.81],
  "fluid": { "solver": "wcsph", "spacing": 0.02, "max_speed": 3, "viscosity": 1 },
  "bodies": [{ "shape": { "kind": "box", "min": [0, 0], "max": [0.3, 0.4] }, "velocity": [2, 0] }],
  "colliders": [{ "name": "post", "shape": { "kind": "box", "min": [0.31, 0], "max": [0.4, 0.16] } }],
  "sensors": [
    { "name": "post", "kind": "force", "obstacle": "post" },
    { "name": "left", "kind": "force", "side": "x_min" },
    { "name": "right", "kind": "force", "side": "x_max" },
    { "name": "floor", "kind": "force", "side": "y_min" },
    { "name": "top", "kind": "force", "side": "y_max" }
  ],
  "time": { "duration": 0.025, "fps": 40 }
}"#;

/// Whether the particles' momentum changes by what gravity and the sensed forces say; `before` says whether a sample has the
/// force of the step before it instead of the one behind.
fn check_balance(scene: &Scene, mass: f64, before: bool, tolerance: f64) {
    let frames = frames(scene);
    let samples: Vec<&Sample> = frames.iter().flat_map(|frame| &frame.samples).collect();
    let last = &frames[frames.len() - 1];
    assert_eq!(samples.len() as u64, last.steps + 1, "every step is sampled");
    let total = mass * f64::from(last.particles);
    let mut given = DVec3::ZERO;
    let mut walls = DVec3::ZERO;
    for pair in samples.windows(2) {
        let dt = pair[1].time - pair[0].time;
        let sample = pair[usize::from(before)];
        let on_walls: DVec3 = sample.values.iter().map(|f| DVec3::new(f[0], f[1], 0.0)).sum();
        walls += dt * on_walls;
        given += dt * (total * scene.gravity.as_dvec3() - on_walls);
    }
    let change = momentum(last, mass) - momentum(&frames[0], mass);
    let size = total * scene.gravity.as_dvec3().length() * last.time;
    assert!(
        walls.length() > 0.3 * size,
        "walls do something: {walls} of {size}"
    );
    assert!(
        (change - given).length() < tolerance * size,
        "momentum changes by {change}; gravity and walls give {given}, with {:?}",
        scene.written.overrides
    );
}

fn fluid_mass(scene: &Scene) -> f64 {
    scene.fluid().expect("a fluid").materials[0].density * (2.0 * scene.radius()).powi(2)
}

#[test]
fn forces_on_walls_close_the_balance_of_momentum() {
    for more in [
        &[][..],
        &["domain.walls=planes"],
        &["fluid.viscosity=0", "fluid.slip=free_slip"],
    ] {
        let overrides = [&["time.sensor_interval=1e-6"][..], more].concat();
        let scene = scene(SPLASH, &overrides);
        check_balance(&scene, fluid_mass(&scene), false, 2e-5);
    }
}

#[test]
fn forces_of_an_incompressible_fluid_close_the_balance_too() {
    // Of water, and of honey, whose viscosity is implicit: what its loop leaves is missing in the balance. Steps that the device
    // would choose longer end at each sample.
    let honey = ["fluid.viscosity=1000", "fluid.max_viscosity_error=1e-4"];
    for (more, tolerance) in [(&[][..], 2e-5), (&honey, 1e-4)] {
        let overrides = [
            "fluid.solver=dfsph",
            "bodies[0].velocity=[0.5,0]",
            "time.sensor_interval=5e-4",
        ];
        let scene = scene(SPLASH, &[&overrides[..], more].concat());
        assert_eq!(
            scene.fluid().expect("a fluid").implicit_viscosity,
            !more.is_empty()
        );
        check_balance(&scene, fluid_mass(&scene), true, tolerance);
    }
}

const GRAINS: &str = r#"{
  "dimensions": 2, "domain": { "min": [0, 0], "max": [0.6, 0.5] }, "gravity": [1, -9.81],
  "grains": { "radius": 0.01, "spring": 2e4, "restitution": 0.3, "shear": 1 },
  "bodies": [{ "shape": { "kind": "box", "min": [0, 0], "max": [0.3, 0.4] }, "velocity": [2, -1] }],
  "colliders": [{ "name": "post", "shape": { "kind": "box", "min": [0.32, 0], "max": [0.4, 0.16] },
    "path": [{ "at": 0, "offset": [0, 0] }, { "at": 1, "offset": [-0.5, 0] }] }],
  "sensors": [
    { "name": "post", "kind": "force", "obstacle": "post" },
    { "name": "left", "kind": "force", "side": "x_min" },
    { "name": "right", "kind": "force", "side": "x_max" },
    { "name": "floor", "kind": "force", "side": "y_min" },
    { "name": "top", "kind": "force", "side": "y_max" }
  ],
  "time": { "duration": 0.02, "fps": 50, "sensor_interval": 1e-6 }
}"#;

#[test]
fn forces_of_grains_close_the_balance_too() {
    let scene = scene(GRAINS, &[]);
    check_balance(&scene, scene.grains().expect("grains").mass, false, 2e-5);
}

#[test]
fn samples_are_taken_when_asked_and_change_no_frame() {
    let plain = scene(SPLASH, &["sensors=[]"]);
    let sampled = scene(SPLASH, &["time.sensor_interval=0.007", "neighbors.skin=0"]);
    let times: Vec<f64> = frames(&sampled)
        .iter()
        .flat_map(|frame| frame.samples.iter().map(|sample| sample.time))
        .collect();
    assert_eq!(times.len(), 4, "{times:?}");
    for (time, k) in times.iter().zip(0..) {
        let late = time - 0.007 * f64::from(k);
        assert!((-1e-9..sampled.time.step).contains(&late), "{times:?}");
    }
    // With each frame, sensors only look.
    let watched = scene(SPLASH, &[]);
    let (plain, watched) = (frames(&plain), frames(&watched));
    for (a, b) in plain.iter().zip(&watched) {
        assert_eq!(a.columns, b.columns);
        assert_eq!((a.samples.len(), b.samples.len()), (0, 1));
    }
}

#[test]
fn a_scene_without_sensors_has_neither_pass_nor_buffer_for_them() {
    let plan = |scene: &Scene| {
        let limits = sliceflow::gpu::device::Limits::PROMISED;
        Plan::new(
            scene,
            &limits,
            &Wanted {
                sensors: true,
                ..Wanted::default()
            },
        )
        .expect("a plan")
    };
    for solver in ["fluid.solver=wcsph", "fluid.solver=dfsph"] {
        let without = plan(&scene(SPLASH, &["sensors=[]", solver]));
        let with = plan(&scene(SPLASH, &[solver]));
        let names = |plan: &Plan| -> Vec<String> { plan.buffers.iter().map(|b| b.name.clone()).collect() };
        let passes = |plan: &Plan| -> Vec<String> {
            let rows = plan.passes.iter().filter(|row| row.phase != Phase::Sample);
            rows.map(|row| row.pass.entry.clone()).collect()
        };
        assert!(without.passes.iter().all(|row| row.phase != Phase::Sample));
        let more: Vec<_> = names(&with)
            .into_iter()
            .filter(|n| !names(&without).contains(n))
            .collect();
        assert_eq!(
            more,
            ["probes", "sensor_samples", "sample_row", "partial_readings"]
        );
        // What presses on walls is known while an incompressible fluid is being solved, and not behind it.
        let more: Vec<_> = passes(&with)
            .into_iter()
            .filter(|p| !passes(&without).contains(p))
            .collect();
        assert_eq!(
            more,
            if solver.ends_with("dfsph") {
                vec!["sense_walls"]
            } else {
                vec![]
            }
        );
    }
}

#[test]
fn what_cannot_be_measured_is_refused_with_help() {
    let refused = |text: &str, sensors: &str, place: &str, words: &[&str]| {
        let overrides = [format!("sensors={sensors}")];
        let error = load::parse(text, "test.json", Path::new("."), &overrides)
            .err()
            .unwrap_or_else(|| panic!("{sensors} is no sensor"))
            .to_string();
        for word in [place].iter().chain(words) {
            assert!(error.contains(word), "{sensors}: `{word}` is missing in\n{error}");
        }
    };
    let fluid = |sensors: &str, place: &str, words: &[&str]| refused(SPLASH, sensors, place, words);
    let grains = |sensors: &str, place: &str, words: &[&str]| refused(GRAINS, sensors, place, words);
    let point = |at: &str| format!(r#"[{{"name":"a","kind":"point","at":{at}}}]"#);
    fluid(
        &point("[0.7,0.1]"),
        "sensors[0].at",
        &["x = 0.7 m lies outside", "from 0 to 0.6 m"],
    );
    fluid(&point("[0.1,0.1,0.1]"), "sensors[0].at", &["2D"]);
    fluid(
        r#"[{"name":"a","kind":"flux","min":[0.1,0.1],"max":[0.1,0.1]}]"#,
        "sensors[0]",
        &["no extent"],
    );
    fluid(
        r#"[{"name":"a","kind":"flux","min":[0.1,0.1],"max":[0.2,0.2]}]"#,
        "sensors[0]",
        &["box", "equal along one axis"],
    );
    fluid(
        r#"[{"name":"a","kind":"force","obstacle":"pots"}]"#,
        "sensors[0].obstacle",
        &["no obstacle \"pots\"", "did you mean `post`?"],
    );
    fluid(r#"[{"name":"a","kind":"force"}]"#, "sensors[0]", &["neither"]);
    fluid(
        r#"[{"name":"a","kind":"force","obstacle":"post","side":"x_min"}]"#,
        "sensors[0]",
        &["both"],
    );
    fluid(
        r#"[{"name":"a","kind":"force","side":"z_min"}]"#,
        "sensors[0].side",
        &["2D"],
    );
    fluid(
        r#"[{"name":"a b","kind":"force","side":"x_min"}]"#,
        "sensors[0].name",
        &["a b"],
    );
    fluid(
        r#"[{"name":"a","kind":"force","side":"x_min"},{"name":"a","kind":"force","side":"x_max"}]"#,
        "sensors[1].name",
        &["same name"],
    );
    fluid(
        r#"[{"name":"a","kind":"height","from":[0.1,0.2],"to":[0.1,0.2]}]"#,
        "sensors[0]",
        &["0 m long"],
    );
    fluid(
        r#"[{"name":"a","kind":"extremes","field":"speed","min":[0.3,0],"max":[0.2,1]}]"#,
        "sensors[0]",
        &["empty", "along x"],
    );
    fluid(
        r#"[{"name":"a","kind":"profile","axis":"z"}]"#,
        "sensors[0].axis",
        &["2D"],
    );
    fluid(
        r#"[{"name":"a","kind":"point","at":[0.1,0.1],"field":"position"}]"#,
        "sensors[0].field",
        &["position"],
    );
    grains(&point("[0.1,0.1]"), "sensors[0]", &["grains", "`extremes`"]);
    grains(
        r#"[{"name":"a","kind":"extremes","field":"pressure"}]"#,
        "sensors[0].field",
        &["no pressure", "`force`"],
    );
    grains(
        r#"[{"name":"a","kind":"height","from":[0.1,0.1]}]"#,
        "sensors[0]",
        &["grains"],
    );
    let open = |side: &str, words: &[&str]| {
        let overrides = [
            format!("domain.sides={{\"y_max\":\"{side}\"}}"),
            r#"sensors=[{"name":"a","kind":"force","side":"y_max"}]"#.to_owned(),
        ];
        let text = if side == "clamp" { GRAINS } else { SPLASH };
        let error = load::parse(text, "test.json", Path::new("."), &overrides);
        let error = error.expect_err("no force").to_string();
        for word in words {
            assert!(error.contains(word), "{error}");
        }
    };
    open("open", &["sensors[0].side", "is open"]);
    open("clamp", &["sensors[0].side", "without a force"]);
}

/// A table's header and rows; NaN for empty cells.
#[cfg(feature = "cli")]
fn table(path: &Path) -> (Vec<String>, Vec<Vec<f64>>) {
    let text = std::fs::read_to_string(path).unwrap_or_else(|reason| panic!("{}: {reason}", path.display()));
    let mut lines = text.lines();
    let header = lines
        .next()
        .expect("a header")
        .split(',')
        .map(str::to_owned)
        .collect();
    let row = |line: &str| {
        line.split(',')
            .map(|cell| cell.parse().unwrap_or(f64::NAN))
            .collect()
    };
    (header, lines.map(row).collect())
}

#[cfg(feature = "cli")]
#[test]
fn particle_files_tell_afterwards_what_the_device_found() {
    let temporary = tempfile::tempdir().expect("a folder");
    let place = |name: &str| temporary.path().join(name);
    let sliceflow = |args: &[&str]| {
        let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin!("sliceflow"));
        let output = command
            .current_dir(temporary.path())
            .args(args)
            .output()
            .expect("it runs");
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{told}");
        (String::from_utf8_lossy(&output.stdout).into_owned(), told)
    };
    std::fs::write(place("still.json"), still_water(2)).expect("a scene");
    let columns = "position,velocity,density,pressure";
    let set = [
        "fluid.spacing=0.02",
        "time.duration=0.04",
        "time.fps=50",
        "bodies[0].velocity=[0.5,0]",
    ];
    let mut run = vec![
        "run",
        "still.json",
        "--out",
        "run",
        "--no-pictures",
        "--particles",
        "npy",
        "--columns",
        columns,
    ];
    run.extend(set.iter().flat_map(|one| ["--set", one]));
    sliceflow(&run);
    let (_, told) = sliceflow(&["measure", "run", "--out", "again"]);
    assert!(told.contains("floor, left"), "{told}");
    for name in ["sensors.csv", "sensor_pressures.csv"] {
        let (titles, device) = table(&place("run").join(name));
        let (found, host) = table(&place("again").join(name));
        assert!(
            titles.starts_with(&["time_s".into(), "step".into(), "frame".into()]),
            "{titles:?}"
        );
        assert_eq!(
            (device.len(), host.len()),
            if name == "sensors.csv" { (3, 3) } else { (9, 9) }
        );
        for (column, title) in found.iter().enumerate() {
            let own = titles
                .iter()
                .position(|known| known == title)
                .expect("the same title");
            for (a, b) in device.iter().zip(&host) {
                let (a, b) = (a[own], b[column]);
                // The surface is found where a sum passes a bound.
                let tolerance = if title.contains("height") {
                    1e-4
                } else {
                    2e-5 * a.abs().max(1.0)
                };
                assert!(
                    a.is_nan() && b.is_nan() || (a - b).abs() <= tolerance,
                    "{name} {title}: {a} and {b}"
                );
            }
        }
    }
    #[cfg(feature = "plots")]
    for chart in [
        "run/sensors_pressure.png",
        "run/sensors_force.png",
        "again/sensor_pressures.png",
    ] {
        assert!(place(chart).exists(), "{chart}");
    }

    // Other sensors, printed.
    let gauges = r#"[{ "name": "far", "kind": "extremes", "field": "position" }]"#;
    std::fs::write(place("gauges.json"), gauges).expect("sensors");
    let (printed, _) = sliceflow(&["measure", "run", "--sensors", "gauges.json"]);
    assert!(
        printed.starts_with("time_s,step,frame,far_lowest_position_x_m,"),
        "{printed}"
    );
    assert_eq!(printed.lines().count(), 4);
}
