//! Grains, obstacles and sides of several materials; cohesion; surfaces that turn.

use glam::DVec3;
use serde_json::{Value, json};
use sliceflow::scene::Particles;

use crate::rotating::{G, empty, floor, frames, mass, parse, scene, stepped, vectors};

/// A linear spring and three materials.
fn with_materials() -> Value {
    json!({
        "radius": 0.01, "law": "linear", "contact_time": 1e-3, "restitution": 0.9, "friction": 0,
        "materials": [{ "name": "lead", "restitution": 0.4 }, { "name": "cork", "restitution": 0.6 }],
        "pairs": [{ "between": ["cork", "lead"], "restitution": 0.2 }]
    })
}

#[test]
fn a_walls_material_says_how_grains_rebound_from_it() {
    let mut file = floor(0.2, [0.0; 3], with_materials());
    file["domain"]["sides"] = json!({ "y_min": "contact", "x_max": "contact" });
    file["domain"]["side_materials"] = json!({ "y_min": "lead" });
    file["colliders"] = json!([
        { "shape": { "kind": "box", "min": [-0.2, 0.3, -0.2], "max": [0.2, 0.35, 0.2] }, "material": "cork" },
        { "shape": { "kind": "box", "min": [-0.2, 0, -0.2], "max": [-0.15, 0.2, 0.2] } }
    ]);
    let speed = 0.5;
    // Towards the floor, the two boxes, and the side.
    let thrown = [
        (DVec3::new(0.0, 0.012, 0.0), -DVec3::Y),
        (DVec3::new(0.0, 0.288, 0.0), DVec3::Y),
        (DVec3::new(-0.138, 0.1, 0.0), -DVec3::X),
        (DVec3::new(0.188, 0.1, 0.0), DVec3::X),
    ]
    .map(|(place, way)| (place, speed * way));
    // At a wall, a contact lasts √2 times as long.
    let last = frames(&stepped(scene(&file, &thrown), 1e-3 / 50.0, 400), 1)
        .pop()
        .unwrap();
    for (after, expected) in vectors(&last, "velocity").iter().zip([0.4, 0.6, 0.9, 0.9]) {
        let found = after.length() / speed;
        assert!((found - expected).abs() < 2e-3, "{found}, and not {expected}");
    }
}

#[test]
fn grains_of_two_materials_rebound_as_their_pair_or_their_mean_says() {
    let mut file = empty(0.5, with_materials());
    let body = |material: Option<&str>, x: f64| {
        let mut body = json!({ "shape": { "kind": "sphere", "center": [x, 0, 0], "radius": 0.015 } });
        if let Some(name) = material {
            body["material"] = name.into();
        }
        body
    };
    file["bodies"] = json!([body(None, -0.3), body(Some("lead"), 0.0), body(Some("cork"), 0.3)]);
    file["time"]["steps_per_contact"] = json!(50);
    let mut pairs = parse(&file).unwrap();
    let materials = [0, 0, 1, 1, 0, 1, 1, 2];
    let expected = [0.9, 0.4, (0.9f64 * 0.4).sqrt(), 0.2];
    let speed = 0.5;
    let mut particles = Vec::new();
    for pair in 0..4 {
        let center = DVec3::new(0.0, 0.1 * f64::from(pair), 0.0);
        let half = DVec3::X * 0.0102;
        particles.push((center - half, DVec3::X * speed));
        particles.push((center + half, -DVec3::X * speed));
    }
    let placed = scene(&file, &particles);
    pairs.particles = Particles {
        material: materials.to_vec(),
        ..placed.particles
    };
    pairs.capacity = 8;
    let last = frames(&stepped(pairs, 1e-3 / 50.0, 100), 1).pop().unwrap();
    let after = vectors(&last, "velocity");
    for (pair, expected) in after.chunks(2).zip(expected) {
        let found = (pair[1].x - pair[0].x) / (2.0 * speed);
        assert!((found - expected).abs() < 2e-3, "{found}, and not {expected}");
    }
}

#[test]
fn cohesion_holds_a_grain_up_to_its_pull_and_gives_its_work_back() {
    let (radius, spring) = (0.01, 1e3);
    let weight = mass(radius, 2500.0) * G;
    let cohesive = |pull: f64| {
        json!({
            "radius": radius, "law": "linear", "spring": spring, "restitution": 1, "cohesion": pull,
            "cohesion_range": 0.2 * radius
        })
    };
    // Below a ceiling.
    for (share, holds) in [(1.1, true), (0.9, false)] {
        let mut file = floor(0.2, [0.0, -G, 0.0], cohesive(share * weight));
        file["grains"]["restitution"] = json!(0.3);
        file["domain"]["sides"] = json!({ "y_max": "contact" });
        let under = scene(&file, &[(DVec3::new(0.0, 0.4 - radius, 0.0), DVec3::ZERO)]);
        let duration = under.time.contact_duration.unwrap();
        let last = frames(&stepped(under, duration / 25.0, 2000), 1).pop().unwrap();
        let hangs = vectors(&last, "position")[0].y > 0.4 - 1.05 * radius;
        assert_eq!(hangs, holds, "{share}");
    }
    // Two grains that fly apart lose the work to the end of the range: half the pull times the range.
    let (pull, speed) = (0.02, 0.1);
    let half = DVec3::X * radius;
    let pair = [(-half, -DVec3::X * speed), (half, DVec3::X * speed)];
    let apart = scene(&empty(0.2, cohesive(pull)), &pair);
    let step = apart.time.contact_duration.unwrap() / 50.0;
    let last = frames(&stepped(apart, step, 2000), 1).pop().unwrap();
    let energy = |v: f64| 2.0 * 0.5 * mass(radius, 2500.0) * v * v;
    let lost = energy(speed) - energy(vectors(&last, "velocity")[1].x);
    let work = 0.5 * pull * 0.2 * radius;
    assert!((lost / work - 1.0).abs() < 0.01, "{lost:e}, and not {work:e}");
}

#[test]
fn a_spinning_tube_takes_a_grain_along() {
    // Without weight a grain in a tube is pressed to its wall by its own way round, and comes to roll on it.
    let (tube, radius, spin) = (0.1, 0.01, 20.0);
    let grains =
        json!({ "radius": radius, "law": "linear", "spring": 1e5, "restitution": 0.3, "friction": 0.5 });
    let mut file = empty(0.2, grains);
    file["colliders"] = json!([{
        "shape": { "kind": "cylinder", "from": [0, 0, -0.1], "to": [0, 0, 0.1], "radius": tube, "hollow": true },
        "spin": spin
    }]);
    file["bodies"][0]["shape"]["radius"] = json!(0.03);
    let around = tube - radius;
    let begin = scene(&file, &[(DVec3::X * around, DVec3::Y * 0.5)]);
    let step = begin.time.contact_duration.unwrap() / 40.0;
    let last = frames(&stepped(begin, step, 20_000), 1).pop().unwrap();
    let (x, v, w) = ["position", "velocity", "angular_velocity"]
        .map(|name| vectors(&last, name)[0])
        .into();
    let outwards = x.normalize();
    let surface = v + w.cross(outwards * radius);
    let wall = DVec3::Z.cross(outwards) * (spin * tube);
    assert!(
        (surface - wall).length() < 0.01 * spin * tube,
        "{surface} on {wall}"
    );
    // Of what its surface lacks in speed, a ball gets 2/7 as its own.
    let speed = v.dot(DVec3::Z.cross(outwards));
    let expected = 0.5 + 2.0 / 7.0 * (spin * tube - 0.5);
    assert!(
        (speed / expected - 1.0).abs() < 0.01,
        "{speed}, and not {expected}"
    );
    assert!((x.length() / around - 1.0).abs() < 0.01, "{x}");
}

#[test]
fn wrong_materials_are_told() {
    let told = |change: &dyn Fn(&mut Value)| {
        let mut file = floor(1.0, [0.0; 3], with_materials());
        change(&mut file);
        parse(&file).expect_err("a problem").to_string()
    };
    let text = told(&|file| file["bodies"][0]["material"] = json!("led"));
    assert!(
        text.contains("bodies[0].material") && text.contains("`lead`?"),
        "{text}"
    );
    let text = told(&|file| file["domain"]["side_materials"] = json!({ "x_min": "lead" }));
    assert!(
        text.contains("domain.side_materials.x_min") && text.contains("`contact`"),
        "{text}"
    );
    let text = told(&|file| file["grains"]["materials"][1]["name"] = json!("lead"));
    assert!(text.contains("grains.materials[1].name"), "{text}");
    let text = told(&|file| file["grains"]["materials"][0]["young_modulus"] = json!(1e7));
    assert!(text.contains("grains.materials[0].young_modulus"), "{text}");
    let text = told(&|file| file["grains"]["pairs"][0]["between"] = json!(["cork", "tin"]));
    assert!(text.contains("grains.pairs[0].between"), "{text}");
    let text = told(&|file| file["grains"]["cohesion_range"] = json!(0.001));
    assert!(text.contains("without cohesion"), "{text}");
    let text = told(&|file| {
        file["colliders"] =
            json!([{ "shape": { "kind": "box", "min": [0, 0, 0], "max": [1, 1, 1] }, "spin": 1 }]);
    });
    assert!(text.contains("colliders[0].spin"), "{text}");
}
