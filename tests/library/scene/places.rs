//! Where particles begin.

use std::path::Path;

use glam::{DVec3, Vec3};
use serde_json::{Value, json};
use sliceflow::scene::{ColliderShape, Scene, load};

use super::{block, message, valid};

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
