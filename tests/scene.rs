//! Scenes: mistakes and their messages, derived numbers, events, `--set`. Needs no GPU.

use std::f64::consts::PI;
use std::path::Path;

use glam::{DVec3, Vec3};
use serde_json::{Value, json};
use sliceflow::error::Error;
use sliceflow::scene::{Action, ColliderShape, Contact, Dimensions, Scene, Scheduled};
use sliceflow::scene::{check, color_maps, library, load};

fn parse(scene: &Value, overrides: &[&str]) -> Result<Scene, Error> {
    let overrides: Vec<String> = overrides.iter().map(|one| one.to_string()).collect();
    load::parse(&scene.to_string(), "test.json", Path::new("tests"), &overrides)
}

fn valid(scene: &Value, overrides: &[&str]) -> Scene {
    parse(scene, overrides).unwrap_or_else(|error| panic!("{error}"))
}

fn message(scene: &Value, overrides: &[&str]) -> String {
    parse(scene, overrides)
        .expect_err("the scene should be refused")
        .to_string()
}

/// A 3D box of 2 m with a block of 4³ grains.
fn block() -> Value {
    json!({
        "domain": { "min": [-1, -1, -1], "max": [1, 1, 1] },
        "grains": { "radius": 0.05, "density": 1000, "spring": 1000, "restitution": 0.5 },
        "bodies": [{ "shape": { "kind": "box", "min": [0, 0, 0], "max": [0.4, 0.4, 0.4] }, "velocity": [1, 0, 0] }],
        "time": { "duration": 2, "fps": 10 }
    })
}

fn assert_near(value: f64, expected: f64) {
    assert!(
        (value - expected).abs() <= 1e-9 * expected.abs(),
        "{value} is not {expected}"
    );
}

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
fn an_unknown_name_suggests_the_nearest() {
    let error = load::load(Path::new("gren_cube"), &[]).unwrap_err();
    assert!(matches!(error, Error::Usage { .. }));
    assert!(
        error.to_string().contains("did you mean `green_cube`?"),
        "{error}"
    );
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
fn lattice_fills_the_box() {
    let scene = valid(&block(), &[]);
    assert_eq!(scene.particles.len(), 64);
    assert_eq!(scene.capacity, 64);
    assert!(scene.particles.velocity.iter().all(|v| *v == Vec3::X));
    assert!(
        scene
            .particles
            .position
            .iter()
            .any(|p| p.distance(Vec3::splat(0.05)) < 1e-6)
    );
}

// Contacts

/// Kilograms, of `block`'s grains.
fn ball_mass() -> f64 {
    1000.0 * 4.0 / 3.0 * PI * 0.05f64.powi(3)
}

/// Speed after over before a head-on contact: the oscillator m_eff x″ = −k x − η x′, integrated until it parts.
fn rebound(spring: f64, damping: f64, effective_mass: f64) -> (f64, f64) {
    let (mut x, mut v, mut time) = (0.0, 1.0, 0.0);
    let dt = 1e-4 * (effective_mass / spring).sqrt();
    let slope = |x: f64, v: f64| (-spring * x - damping * v) / effective_mass;
    loop {
        // Midpoint rule.
        let (half_x, half_v) = (x + v * dt / 2.0, v + slope(x, v) * dt / 2.0);
        let (next_x, next_v) = (x + half_v * dt, v + slope(half_x, half_v) * dt);
        if next_x < 0.0 {
            return (-next_v, time);
        }
        (x, v, time) = (next_x, next_v, time + dt);
    }
}

#[test]
fn restitution_and_duration_are_those_of_the_oscillator() {
    let mass = ball_mass();
    for e in [0.2, 0.5, 0.9] {
        let mut given = block();
        given["grains"]["restitution"] = json!(e);
        let scene = valid(&given, &[]);
        assert_near(scene.grains().unwrap().mass, mass);
        let contact = scene.grains().unwrap().contact.clone();
        let (after, duration) = rebound(contact.spring, contact.damping, mass / 2.0);
        assert!((after - e).abs() < 1e-3, "two grains: {after} for {e}");
        assert!((scene.time.contact_duration.unwrap() / duration - 1.0).abs() < 1e-3);
        let (after, _) = rebound(contact.spring, contact.wall_damping, mass);
        assert!((after - e).abs() < 1e-3, "wall: {after} for {e}");
    }
}

#[test]
fn a_damping_is_taken_as_given() {
    let mut given = block();
    given["grains"] = json!({ "radius": 0.05, "spring": 1000, "damping": 2.5 });
    let contact = valid(&given, &[]).grains().unwrap().contact.clone();
    assert_eq!((contact.damping, contact.wall_damping), (2.5, 2.5));
}

#[test]
fn a_disc_is_one_metre_thick() {
    let scene = valid(
        &json!({
            "dimensions": 2,
            "domain": { "min": [0, 0], "max": [1, 1] },
            "gravity": [0, -1, 0],
            "grains": { "radius": 0.1, "density": 10, "spring": 1000, "restitution": 1 },
            "bodies": [{ "shape": { "kind": "box", "min": [0, 0], "max": [0.4, 0.6] } }]
        }),
        &[],
    );
    assert_eq!(scene.dimensions, Dimensions::Two);
    assert_near(scene.grains().unwrap().mass, 10.0 * PI * 0.01);
    assert_eq!(scene.particles.len(), 6);
    assert_eq!((scene.domain.min.z, scene.domain.max.z), (0.0, 0.0));
    assert!(scene.particles.position.iter().all(|p| p.z == 0.0));
    assert_eq!(scene.grains().unwrap().contact.damping, 0.0);
}

// Time

#[test]
fn steps_resolve_the_contact_and_land_on_frames() {
    let time = valid(&block(), &[]).time;
    assert_eq!(time.frames, 21);
    assert_eq!(time.limited_by, "contact duration");
    assert_near(time.step * f64::from(time.steps_per_frame), 0.1);
    assert!(time.step <= time.contact_duration.unwrap() / 40.0);
    assert!(0.1 / f64::from(time.steps_per_frame - 1) > time.contact_duration.unwrap() / 40.0);
}

#[test]
fn an_event_that_stiffens_contacts_shortens_every_step() {
    let mut given = block();
    let soft = valid(&given, &[]).time.contact_duration.unwrap();
    given["events"] = json!([{ "at": 1, "set": { "spring": 4000 } }]);
    assert_near(valid(&given, &[]).time.contact_duration.unwrap(), soft / 2.0);
    given["events"] = json!([{ "at": 3, "set": { "spring": 4000 } }]);
    let late = valid(&given, &[]);
    assert_near(late.time.contact_duration.unwrap(), soft);
    assert_eq!(late.notes.len(), 1);
}

#[test]
fn the_scenes_step_is_kept_or_refused_with_one_that_fits() {
    let duration = valid(&block(), &[]).time.contact_duration.unwrap();
    let kept = valid(&block(), &[&format!("time.step={}", duration / 25.0)]).time;
    assert_eq!(kept.limited_by, "scene's step");
    assert_near(kept.step, 0.1 / (0.1 / (duration / 25.0)).ceil());
    let refused = message(&block(), &[&format!("time.step={}", duration / 19.0)]);
    let (_, after) = refused.split_once("at most ").unwrap();
    let fits = after.split(' ').next().unwrap();
    let relative: f64 = fits.parse::<f64>().unwrap() / (duration / 20.0);
    assert!((relative - 1.0).abs() < 1e-5);
}

#[test]
fn strong_damping_shortens_the_step() {
    let time = valid(&block(), &["grains.shear=1000"]).time;
    assert_eq!(time.limited_by, "damping");
    let contact = valid(&block(), &["grains.shear=1000"])
        .grains()
        .unwrap()
        .contact
        .clone();
    let share = (contact.damping + contact.shear) * time.step / (ball_mass() / 2.0);
    assert!(share <= 0.5 && share > 0.49, "{share}");
}

#[test]
fn an_overdamped_contact_has_a_finite_duration() {
    let mut given = block();
    given["grains"] = json!({ "radius": 0.05, "density": 1000, "spring": 1000, "damping": 1000 });
    let scene = valid(&given, &[]);
    assert_near(
        scene.time.contact_duration.unwrap(),
        PI * ball_mass() / 2.0 / 1000.0,
    );
}

// Places

/// `block` with every kind of coordinate in it, moved.
fn moved(by: [f64; 3]) -> Value {
    let at = |x: f64, y: f64, z: f64| json!([x + by[0], y + by[1], z + by[2]]);
    json!({
        "domain": { "min": at(-0.93, -1.0, -1.1), "max": at(1.0, 1.0, 1.3) },
        "grains": { "radius": 0.037, "spring": 1000, "restitution": 0.5 },
        "bodies": [
            { "shape": { "kind": "box", "min": at(-0.9, -0.9, -0.9), "max": at(-0.31, 0.4, 0.1) }, "jitter": 0.1 },
            { "shape": { "kind": "sphere", "center": at(0.37, 0.41, 0.3), "radius": 0.3 } }
        ],
        "colliders": [
            { "name": "a", "shape": { "kind": "plane", "point": at(0.0, -0.97, 0.0), "normal": [0.1, 1, 0] } },
            { "shape": { "kind": "box", "min": at(0.11, -0.9, 0.2), "max": at(0.33, -0.7, 0.5) } },
            { "shape": { "kind": "sphere", "center": at(0.77, -0.7, 0.7), "radius": 0.1 } }
        ],
        "emitters": [{ "name": "tap", "center": at(0.1, 0.9, -0.3), "radius": 0.1, "velocity": [0, -1, 0.3] }],
        "events": [
            { "at": 1.5, "drop": { "center": at(0.6, 0.1, 0.9), "radius": 0.15 } },
            { "at": 1, "move": { "collider": "a", "by": [0, 0.1, 0], "during": 1 } }
        ],
        "render": { "camera": { "eye": at(3.0, 2.0, 1.0), "target": at(0.3, 0.0, 0.0) } }
    })
}

/// Every local number of a scene, bit for bit.
fn bits(scene: &Scene) -> String {
    let words = |points: &[Vec3]| {
        points
            .iter()
            .map(|p| p.to_array().map(f32::to_bits))
            .collect::<Vec<_>>()
    };
    let Scene {
        domain, particles, ..
    } = scene;
    let actions: Vec<_> = scene
        .schedule
        .iter()
        .map(|s| format!("{} {:?}", s.time, s.action))
        .collect();
    format!(
        "{:?} {:?} {:?} {:?} {actions:?} {:?}",
        words(&[domain.min, domain.max]),
        words(&particles.position),
        words(&particles.velocity),
        scene.colliders,
        scene.render.camera,
    )
}

#[test]
fn a_scene_a_million_metres_away_is_the_same() {
    let near = valid(&moved([0.0; 3]), &[]);
    let far = valid(&moved([1e6, -1e6, 1e6]), &[]);
    assert!(far.origin.distance(near.origin + DVec3::new(1e6, -1e6, 1e6)) < 1e-9);
    assert!(near.particles.len() > 1000);
    assert!(bits(&near) == bits(&far));
}

#[test]
fn a_few_overlaps_are_left_out_and_told() {
    let mut given = block();
    let body = given["bodies"][0].clone();
    given["bodies"] = json!([body, body]);
    given["bodies"][1]["shape"]["min"] = json!([0, 0.3, 0]);
    given["bodies"][1]["shape"]["max"] = json!([0.4, 0.7, 0.4]);
    let scene = valid(&given, &[]);
    assert_eq!(scene.particles.len(), 64 + 48);
    assert_eq!(
        scene.notes,
        ["bodies[1]: 16 of 64 particles overlap bodies[0] and were left out"]
    );
    // Side by side nothing overlaps.
    given["bodies"][1]["shape"]["min"] = json!([0, 0.4, 0]);
    given["bodies"][1]["shape"]["max"] = json!([0.4, 0.8, 0.4]);
    let scene = valid(&given, &[]);
    assert_eq!((scene.particles.len(), scene.notes.len()), (128, 0));
}

/// Whatever the spacing, water reaches every wall that its box reaches, and has the box's volume.
#[test]
fn fluid_fills_its_boxes_from_wall_to_wall() {
    let scene = |overrides: &[&str]| {
        let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
        load::load(Path::new("spheric_2"), &overrides).unwrap()
    };
    for (spacing, counts) in [("0.0366", [34, 15, 27]), ("0.05", [25, 11, 20])] {
        let scene = scene(&[&format!("fluid.spacing={spacing}")]);
        let number: usize = counts.iter().product();
        assert_eq!(scene.first_boundary() as usize, number, "{spacing}");
        let water = &scene.positions()[..number];
        let (low, high) = water.iter().fold((Vec3::MAX, Vec3::MIN), |(low, high), p| {
            (low.min(*p), high.max(*p))
        });
        let box_ =
            [Vec3::new(1.992, 0.0, 0.0), Vec3::new(3.22, 0.55, 1.0)].map(|p| p - scene.origin.as_vec3());
        let half = (box_[1] - box_[0]) / Vec3::from(counts.map(|n| 2.0 * n as f32));
        // Water under its own weight is a little lower.
        let lower = Vec3::new(0.0, 0.0015, 0.0);
        assert!(
            (low - box_[0] - half).abs().max_element() < 2e-4,
            "{spacing}: {low}"
        );
        assert!(
            (box_[1] - high - half - lower).abs().max_element() < 2e-4,
            "{spacing}: {high}"
        );
        let fluid = scene.fluid().unwrap();
        let volume = number as f64 * fluid.volume(scene.dimensions);
        assert!(
            (volume / (1.228 * 0.55) - 1.0).abs() < 1e-6,
            "{spacing}: {volume} m³"
        );
    }
    let told = scene(&["fluid.spacing=0.045"]).notes;
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(
        told[0].starts_with("fluid.spacing: 0.045 m became 0.04558"),
        "{told:?}"
    );
    assert_eq!(scene(&[]).notes, [""; 0]);
    // As a file says that holds f32.
    let nearly = scene(&[
        "fluid.spacing=0.05",
        "bodies[0].shape.max=[3.192,0.54999998,0.99999998]",
    ]);
    assert_eq!(nearly.first_boundary(), 24 * 11 * 20);
    assert_eq!(nearly.radius(), 0.025);
    let vortices = |spacing: &str| {
        let overrides = [format!("fluid.spacing={spacing}")];
        load::load(Path::new("taylor_green_3d"), &overrides).unwrap()
    };
    for spacing in ["0.39269908", "0.39269908169872414", "0.3926990817"] {
        assert_eq!(vortices(spacing).first_boundary(), 16 * 16 * 16, "{spacing}");
    }
}

/// One spacing cannot fill two boxes exactly: neither loses particles to the other, and what is too much is told.
#[test]
fn boxes_that_share_a_spacing_stay_whole() {
    let mut given = json!({
        "dimensions": 2,
        "domain": { "min": [0, 0], "max": [1, 1] },
        "fluid": { "solver": "wcsph", "spacing": 0.1 },
        "bodies": [
            { "shape": { "kind": "box", "min": [0, 0], "max": [0.46, 0.5] } },
            { "shape": { "kind": "box", "min": [0.46, 0], "max": [1, 0.53] } }
        ]
    });
    let scene = valid(&given, &[]);
    assert_eq!(scene.first_boundary(), 25 + 25);
    assert_eq!(scene.notes.len(), 3, "{:?}", scene.notes);
    assert!(
        scene.notes[1].contains("bodies[0]: its sides are not whole numbers of spacings"),
        "{:?}",
        scene.notes
    );
    assert!(
        scene.notes[1].contains("% more than the box"),
        "{:?}",
        scene.notes
    );
    assert!(
        scene.notes[2].contains("% less than the box"),
        "{:?}",
        scene.notes
    );
    // A spacing that a body asks for stays.
    given["bodies"][1]["spacing"] = json!(0.1);
    let scene = valid(&given, &[]);
    assert_eq!(scene.radius(), 0.05);
}

#[test]
fn grains_inside_colliders_are_left_out() {
    let shapes = [
        json!({ "kind": "plane", "point": [0, 0.1, 0], "normal": [0, 2, 0] }),
        json!({ "kind": "box", "min": [-1, -1, -1], "max": [1, 0.1, 1] }),
        json!({ "kind": "sphere", "center": [0.2, -100, 0.2], "radius": 100.099 }),
    ];
    for shape in shapes {
        let mut given = block();
        given["colliders"] = json!([{ "shape": shape }]);
        let scene = valid(&given, &[]);
        assert_eq!(scene.particles.len(), 48, "{shape}");
        assert_eq!(
            scene.notes,
            ["bodies[0]: 16 of 64 particles overlap colliders[0] and were left out"]
        );
        if let ColliderShape::Plane { normal, .. } = scene.colliders[0].shape {
            assert_eq!(normal, Vec3::Y);
        }
    }
}

#[test]
fn an_open_side_lets_grains_reach_through() {
    let mut given = block();
    given["bodies"][0]["shape"] = json!({ "kind": "box", "min": [0.65, 0, 0], "max": [1.05, 0.4, 0.4] });
    assert!(message(&given, &[]).contains("reaches through the domain's side x_max, by 0.05 m"));
    given["domain"]["sides"] = json!({ "x_max": "open" });
    assert_eq!(valid(&given, &[]).particles.len(), 64);
}

// Events

fn added(scheduled: &Scheduled) -> usize {
    match &scheduled.action {
        Action::Add(particles) => particles.len(),
        Action::SetParameters { .. } => 0,
    }
}

#[test]
fn events_keep_what_they_do_not_change() {
    let mut given = block();
    given["events"] = json!([
        { "at": 1.5, "set": { "gravity": [1, 0, 0] } },
        { "at": 0.5, "set": { "spring": 4000 } }
    ]);
    let scene = valid(&given, &[]);
    let parameters: Vec<(f64, Vec3, Contact)> = scene
        .schedule
        .iter()
        .filter_map(|scheduled| match &scheduled.action {
            Action::SetParameters { gravity, matter } => {
                Some((scheduled.time, *gravity, matter.grains()?.contact.clone()))
            }
            Action::Add(_) => None,
        })
        .collect();
    let [(first, gravity, ref stiff), (second, turned, ref later)] = parameters[..] else {
        panic!("{parameters:?}");
    };
    assert_eq!((first, second), (0.5, 1.5));
    assert_eq!(gravity, scene.gravity);
    assert_eq!(turned, Vec3::X);
    assert_eq!(stiff, later);
    assert_eq!(stiff.spring, 4000.0);
    // The restitution of 0.5 holds on.
    assert_near(stiff.damping, 2.0 * scene.grains().unwrap().contact.damping);
}

#[test]
fn events_change_what_a_solver_has_and_nothing_else() {
    let told = |matter: &str, value: Value, set: Value| {
        let mut given = block();
        given.as_object_mut().unwrap().remove("grains");
        given[matter] = value;
        given["events"] = json!([{ "at": 0.5, "set": set }]);
        message(&given, &[])
    };
    let grains = block()["grains"].clone();
    let told_of_grains = told("grains", grains, json!({ "viscosity": 1, "sound_speed": 20 }));
    for part in [
        "events[0].set.viscosity",
        "events[0].set.sound_speed",
        "has no effect on grains",
        "`gravity`, `spring`",
    ] {
        assert!(told_of_grains.contains(part), "{part}: {told_of_grains}");
    }
    let water = json!({ "spacing": 0.1, "solver": "dfsph" });
    let told_of_dfsph = told("fluid", water, json!({ "sound_speed": 20, "spring": 3 }));
    for part in [
        "events[0].set.sound_speed",
        "events[0].set.spring",
        "`gravity`, `viscosity`, `artificial_viscosity`",
    ] {
        assert!(told_of_dfsph.contains(part), "{part}: {told_of_dfsph}");
    }
    let water = json!({ "spacing": 0.1 });
    let told_of_water = told("fluid", water, json!({ "wall_friction": 0.1, "material": "oil" }));
    for part in [
        "wall_friction",
        "sticks to",
        "names a material of which nothing changes",
        "no material is called",
    ] {
        assert!(told_of_water.contains(part), "{part}: {told_of_water}");
    }
}

#[test]
fn a_drop_is_a_ball_of_grains() {
    let mut given = block();
    given["events"] =
        json!([{ "at": 1, "drop": { "center": [0, -0.5, 0], "radius": 0.15, "velocity": [0, -2, 0] } }]);
    let scene = valid(&given, &[]);
    let [
        Scheduled {
            time: 1.0,
            action: Action::Add(ball),
        },
    ] = &scene.schedule[..]
    else {
        panic!("{:?}", scene.schedule);
    };
    // Center and six neighbors at 0.1 m.
    assert_eq!(ball.len(), 7);
    assert!(
        ball.position
            .iter()
            .all(|p| p.distance(Vec3::new(0.0, -0.5, 0.0)) < 0.1001)
    );
    assert!(ball.velocity.iter().all(|v| *v == Vec3::new(0.0, -2.0, 0.0)));
    assert_eq!(scene.capacity, 71);
}

#[test]
fn an_emitter_lets_in_layers_until_it_is_switched_off() {
    let mut given = block();
    // A hexagon: the center and six around it, 0.125 m away; a layer every 0.125 s.
    given["emitters"] = json!([{
        "name": "tap", "center": [0, 0.8, 0], "radius": 0.18, "velocity": [0, -1, 0], "spacing": 0.125, "on": false
    }]);
    given["events"] = json!([
        { "at": 1.0, "emitter": { "name": "tap", "on": false } },
        { "at": 0.5, "emitter": { "name": "tap", "on": true } },
        { "at": 1.75, "emitter": { "name": "tap", "on": true } }
    ]);
    let scene = valid(&given, &[]);
    let times: Vec<f64> = scene.schedule.iter().map(|scheduled| scheduled.time).collect();
    assert_eq!(times, [0.5, 0.625, 0.75, 0.875, 1.75, 1.875]);
    assert!(scene.schedule.iter().all(|scheduled| added(scheduled) == 7));
    assert_eq!(scene.capacity, 64 + 42);
    let Action::Add(layer) = &scene.schedule[0].action else {
        panic!("not a layer");
    };
    for (i, point) in layer.position.iter().enumerate() {
        assert_eq!(point.y, 0.8);
        for other in &layer.position[..i] {
            assert!(point.distance(*other) > 0.1249);
        }
    }
}

#[test]
fn an_emitter_in_2d_is_a_line() {
    let scene = valid(
        &json!({
            "dimensions": 2,
            "domain": { "min": [0, 0], "max": [2, 2] },
            "gravity": [0, 0],
            "grains": { "radius": 0.05, "spring": 1000, "restitution": 0.5 },
            "emitters": [{ "name": "slit", "center": [1, 1], "radius": 0.28, "velocity": [0.3, 0.4] }],
            "time": { "duration": 1, "fps": 10 }
        }),
        &[],
    );
    // 2.2 radii apart at 0.5 m/s: every 0.22 s.
    assert_eq!(scene.schedule.len(), 5);
    assert_near(scene.schedule[1].time, 0.22);
    let Action::Add(layer) = &scene.schedule[4].action else {
        panic!("not a layer");
    };
    assert_eq!(layer.len(), 5);
    for pair in layer.position.windows(2) {
        assert!((pair[0].distance(pair[1]) - 0.11).abs() < 1e-6);
        assert!((pair[1] - pair[0]).dot(Vec3::new(0.3, 0.4, 0.0)).abs() < 1e-6);
    }
}

#[test]
fn moves_go_on_from_where_the_collider_is() {
    let mut given = block();
    given["colliders"] = json!([{
        "name": "piston",
        "shape": { "kind": "sphere", "center": [-0.5, 0, 0], "radius": 0.1 },
        "path": [{ "at": 0, "offset": [0, 0, 0] }, { "at": 1, "offset": [0, 0.5, 0] }]
    }]);
    given["events"] = json!([
        { "at": 1.5, "move": { "collider": "piston", "by": [0, 0, 0.25], "during": 0.25 } },
        { "at": 0.5, "move": { "collider": "piston", "by": [0.5, 0, 0], "during": 0.25 } }
    ]);
    let path = &valid(&given, &[]).colliders[0].path;
    let expected = [
        (0.0, Vec3::ZERO),
        (0.5, Vec3::new(0.0, 0.25, 0.0)),
        (0.75, Vec3::new(0.5, 0.375, 0.0)),
        (1.0, Vec3::new(0.5, 0.5, 0.0)),
        (1.5, Vec3::new(0.5, 0.5, 0.0)),
        (1.75, Vec3::new(0.5, 0.5, 0.25)),
    ];
    assert_eq!(path[..], expected);
}

// Colors

#[test]
fn color_ranges_come_from_the_scene() {
    let fall = (2.0f64 * 9.81 * 2.0).sqrt();
    let expected = [
        ("speed", [0.0, fall]),
        ("velocity_y", [-fall, fall]),
        ("x", [-1.0, 1.0]),
        ("id", [0.0, 63.0]),
        ("contacts", [0.0, 12.0]),
        ("density", [0.0, 1000.0]),
        ("pressure", [0.0, 1000.0 * 9.81 * 2.0]),
        ("slice", [0.0, 20.0]),
    ];
    for (column, [low, high]) in expected {
        let color = valid(&block(), &[&format!("render.color.by={column}")]).color;
        assert_eq!(color.column.name, column);
        assert!(
            (color.range[0] - low).abs() < 1e-9 && (color.range[1] - high).abs() < 1e-9,
            "{column}"
        );
    }
    assert_eq!(valid(&block(), &["gravity=[0,0,0]"]).color.range, [0.0, 1.0]);
}

#[test]
fn color_maps_have_distinct_names_and_the_papers_ends() {
    for (i, map) in color_maps::COLOR_MAPS.iter().enumerate() {
        assert!(
            color_maps::COLOR_MAPS[..i]
                .iter()
                .all(|other| other.name != map.name),
            "{}",
            map.name
        );
        assert_ne!((map.at)(0.0), (map.at)(0.5), "{}", map.name);
    }
    let ends = |name: &str| [0.0, 1.0].map(color_maps::find(name).unwrap().at);
    assert_eq!(ends("white_blue"), [[255, 255, 255], [0, 0, 255]]);
    assert_eq!(ends("rojas"), [[0, 0, 255], [255, 0, 0]]);
    assert_eq!(ends("viridis"), [[68, 1, 84], [253, 231, 37]]);
}

#[test]
fn hex_colors() {
    assert_eq!(color_maps::parse_hex("#8a8f98"), Some([0x8a, 0x8f, 0x98]));
    for wrong in ["8a8f98", "#8a8f9", "#8a8f981", "#8a8f9g", "#+a8f98", "#äää"] {
        assert_eq!(color_maps::parse_hex(wrong), None, "{wrong}");
    }
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

/// Where nothing is beside a particle, the fluid ends.
#[test]
fn free_surfaces_are_found() {
    let folder = library::folder().unwrap();
    let of = |name: &str, overrides: &[&str]| {
        let text = library::find(name).unwrap();
        let overrides: Vec<String> = overrides.iter().map(|&o| o.to_owned()).collect();
        let scene = load::parse(text, "test.json", &folder, &overrides).unwrap();
        scene.fluid().unwrap().free_surface
    };
    for name in [
        "taylor_green_2d",
        "lid_cavity",
        "poiseuille",
        "couette",
        "taylor_couette",
    ] {
        assert!(!of(name, &[]), "{name}");
    }
    assert!(!of("lid_cavity", &["domain.walls=planes"]));
    assert!(!of("taylor_green_3d", &["fluid.spacing=0.1"]));
    for name in [
        "still_water",
        "dam_break_2d",
        "rotating_square",
        "elliptical_drop",
    ] {
        assert!(of(name, &[]), "{name}");
    }
    assert!(of("still_water", &["domain.walls=planes"]));
}
