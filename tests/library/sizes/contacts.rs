//! Contacts of grains of several sizes, against closed forms in f64.

use std::f64::consts::PI;

use glam::DVec3;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::json;
use sliceflow::output::columns_named;
use sliceflow::plan::Wanted;
use sliceflow::scene::Scene;
use sliceflow::simulation::Frame;

use super::{Grain, R, scene, sized};
use crate::common;
use crate::rotating::{G, empty, floor, frames, mass, parse, stepped, vectors};

/// Pairs that meet head-on with 1 m/s, in a frame in which their center of mass rests; they touch at different parts of a step.
fn pairs(radii: &[(f64, f64)], step: f64) -> Vec<Grain> {
    let pair = |(i, &(a, b)): (usize, &(f64, f64))| {
        let share = b.powi(3) / (a.powi(3) + b.powi(3));
        let gap = step * (1.0 + i as f64 / radii.len() as f64);
        let y = 0.05 * i as f64;
        [
            (DVec3::new(-a - gap / 2.0, y, 0.0), DVec3::X * share, a),
            (DVec3::new(b + gap / 2.0, y, 0.0), -DVec3::X * (1.0 - share), b),
        ]
    };
    radii.iter().enumerate().flat_map(pair).collect()
}

const RADII: [(f64, f64); 5] = [
    (R, R),
    (R, R / 4.0),
    (R / 4.0, R / 4.0),
    (0.7 * R, 0.4 * R),
    (R / 4.0, 0.8 * R),
];

fn relative(last: &Frame) -> Vec<f64> {
    let v = vectors(last, "velocity");
    v.chunks(2).map(|pair| pair[1].x - pair[0].x).collect()
}

/// Frames with columns that grains of any law have.
fn plain_frames(scene: &Scene, last: u32) -> Vec<Frame> {
    let wanted = Wanted {
        statistics: true,
        columns: columns_named(["position", "velocity", "radius"]).unwrap(),
        ..Default::default()
    };
    common::frames(&mut common::simulate(scene, &wanted), last)
}

#[test]
fn unequal_grains_rebound_as_asked_and_keep_their_momentum() {
    let laws = [
        ("contact_time", json!({ "law": "linear", "contact_time": 1e-3 })),
        ("spring", json!({ "law": "linear", "spring": 5e4 })),
        (
            "hertz",
            json!({ "law": "hertz", "young_modulus": 1e8, "poisson_ratio": 0.3 }),
        ),
        (
            "spring_dashpot",
            json!({ "law": "spring_dashpot", "spring": 5e4, "dashpot": "normal" }),
        ),
    ];
    for (name, mut grains) in laws {
        for restitution in [0.4, 0.9] {
            grains["restitution"] = json!(restitution);
            let mut file = empty(0.3, sized(grains.clone()));
            file["time"]["integrator"] = json!("velocity_verlet");
            if name != "spring_dashpot" {
                file["time"].as_object_mut().unwrap().remove("integrator");
            }
            // Hertz's contacts last shorter than at the speed that the scene expects.
            let steps = match name {
                "hertz" => 250,
                // Its dashpots begin and end with a jump, an error of the step's length.
                "spring_dashpot" => 500,
                _ => 100,
            };
            let step = parse(&file).unwrap().time.contact_duration.unwrap() / (f64::from(steps) + 0.3);
            let scene = stepped(scene(&file, &pairs(&RADII, step)), step, 24 * steps);
            let last = plain_frames(&scene, 1).pop().unwrap();
            assert_eq!(last.statistics.unwrap().contacts, 0, "{name}");
            for (back, (a, b)) in relative(&last).into_iter().zip(RADII) {
                println!("{name}, {a} and {b} m: {back:.6} for {restitution}");
                assert!(
                    (back - restitution).abs() < 1e-3,
                    "{name}: {back} for {restitution}"
                );
            }
            let v = vectors(&last, "velocity");
            for (pair, (a, b)) in v.chunks(2).zip(RADII) {
                let momentum = a.powi(3) * pair[0].x + b.powi(3) * pair[1].x;
                let each = a.powi(3) * b.powi(3) / (a.powi(3) + b.powi(3));
                assert!((momentum / each).abs() < 1e-5, "{name}: {}", momentum / each);
            }
        }
    }
}

#[test]
fn contacts_last_as_long_as_asked_for_every_two_sizes() {
    let (time, step) = (1e-3, 1e-3 / 200.0);
    for pair in RADII {
        let grains = json!({ "law": "linear", "contact_time": time, "restitution": 0.6 });
        let file = empty(0.3, sized(grains));
        let scene = stepped(scene(&file, &pairs(&[pair], step)), step, 1);
        let all = plain_frames(&scene, 220);
        let touching = all
            .iter()
            .filter(|frame| frame.statistics.unwrap().contacts > 0)
            .count();
        let found = touching as f64 * step / time;
        println!("{pair:?}: {found:.3} of the time");
        assert!((found - 1.0).abs() < 0.01, "{pair:?}: {found} of the time");
    }
}

#[test]
fn unequal_spheres_meet_as_hertz_says() {
    let (young, nu, density, speed) = (48e9, 0.2, 2800.0, 2.0);
    let grains = json!({
        "law": "hertz", "density": density, "young_modulus": young, "poisson_ratio": nu, "restitution": 1, "friction": 0
    });
    let file = empty(0.1, sized(grains));
    for (a, b) in [(R, R / 4.0), (R / 2.0, R / 3.0)] {
        // δ = (15 m* v² / (16 E* √R*))^(2/5), duration 2.943275 δ/v (Hertz 1882).
        let [m, n] = [a, b].map(|r| mass(r, density));
        let (m, r, e) = (m * n / (m + n), a * b / (a + b), young / (2.0 * (1.0 - nu * nu)));
        let deepest = (15.0 * m * speed * speed / (16.0 * e * r.sqrt())).powf(0.4);
        let duration = 2.943_275 * deepest / speed;
        let step = duration / 200.3;
        let mut grains = pairs(&[(a, b)], speed * step);
        grains.iter_mut().for_each(|grain| grain.1 *= speed);
        let all = plain_frames(&stepped(scene(&file, &grains), step, 1), 230);
        let overlap = all.iter().map(|frame| {
            let x = vectors(frame, "position");
            a + b - x[0].distance(x[1])
        });
        let overlap = overlap.fold(0.0, f64::max);
        let told = all
            .iter()
            .map(|frame| frame.statistics.unwrap().max_overlap)
            .fold(0.0, f64::max);
        let last = all.last().unwrap();
        let (x, v) = (vectors(last, "position"), vectors(last, "velocity"));
        let back = (v[1].x - v[0].x) / speed;
        let since = (x[1].x - x[0].x - a - b) / (v[1].x - v[0].x);
        let found = 230.0 * step - step - since;
        println!(
            "{a} and {b}: overlap {:.1e}, duration {:.1e}, restitution {:.1e}",
            overlap / deepest - 1.0,
            found / duration - 1.0,
            back - 1.0
        );
        assert!((overlap / deepest - 1.0).abs() < 2e-3);
        assert!((found / duration - 1.0).abs() < 2e-3);
        assert!((back - 1.0).abs() < 1e-3);
        // Of the smaller radius.
        assert!((told * a.min(b) / overlap - 1.0).abs() < 2e-3, "{told}");
    }
}

#[test]
fn rubbing_grains_of_unequal_size_keep_their_angular_momentum() {
    for dimensions in [2, 3] {
        let grains = json!({
            "law": "linear", "contact_time": 1e-3, "restitution": 0.5, "friction": 0.6, "rolling_friction": 0.2,
            "density": 2500
        });
        let mut file = empty(0.3, sized(grains));
        if dimensions == 2 {
            file["dimensions"] = json!(2);
            file["gravity"] = json!([0, 0]);
            file["domain"] = json!({ "min": [-0.3, -0.3], "max": [0.3, 0.3], "walls": "open" });
            file["bodies"][0]["shape"]["center"] = json!([0, 0]);
        }
        let (a, b) = (R, 0.4 * R);
        let oblique = DVec3::new(1.0, 0.7, 0.0);
        let start = [
            (DVec3::new(-a, 0.0, 0.0), oblique, a),
            (DVec3::new(b + 1e-5, 0.0, 0.0), DVec3::ZERO, b),
        ];
        let step = 1e-3 / 100.0;
        let last = frames(&stepped(scene(&file, &start), step, 120), 1)
            .pop()
            .unwrap();
        assert_eq!(last.statistics.unwrap().contacts, 0);
        let (x, v, w) = (
            vectors(&last, "position"),
            vectors(&last, "velocity"),
            vectors(&last, "angular_velocity"),
        );
        let of = |r: f64| match dimensions {
            2 => (PI * r * r * 2500.0, 0.5),
            _ => (mass(r, 2500.0), 0.4),
        };
        let momentum = |x: &[DVec3], v: &[DVec3], w: &[DVec3]| -> f64 {
            let own = |i: usize| {
                let r = [a, b][i];
                let (m, shape) = of(r);
                m * x[i].cross(v[i]).z + shape * m * r * r * w[i].z
            };
            own(0) + own(1)
        };
        let before = momentum(
            &[start[0].0, start[1].0],
            &[start[0].1, start[1].1],
            &[DVec3::ZERO; 2],
        );
        let after = momentum(&x, &v, &w);
        let spin = of(b).1 * of(b).0 * b * b * w[1].z;
        println!(
            "{dimensions}D: {before:.6e} before, {after:.6e} after, of it {spin:.1e} spin of the small one"
        );
        assert!(spin.abs() > 1e-3 * before.abs(), "they rub");
        assert!(
            (after / before - 1.0).abs() < 1e-5,
            "{dimensions}D: {}",
            after / before - 1.0
        );
        // What they have together, by the figures of a run.
        let energy: f64 = [a, b]
            .iter()
            .enumerate()
            .map(|(i, &r)| {
                let (m, shape) = of(r);
                0.5 * m * v[i].length_squared() + 0.5 * shape * m * r * r * w[i].length_squared()
            })
            .sum();
        let told = last.statistics.unwrap().kinetic_energy;
        assert!((told / energy - 1.0).abs() < 1e-5, "{told} J for {energy} J");
    }
}

#[test]
fn grains_of_each_size_rest_and_rebound_at_walls() {
    let spring = 2000.0;
    let grains = json!({ "law": "linear", "spring": spring, "restitution": 0.6, "density": 2500 });
    let mut file = floor(0.1, [0.0, -G, 0.0], sized(grains));
    // Half of them stand on an obstacle.
    file["colliders"] = json!([
        { "shape": { "kind": "box", "min": [-0.1, 0, 0.04], "max": [0.1, 0.02, 0.1] } }
    ]);
    let radii = [R, R / 2.0, R / 4.0];
    let mut start = Vec::new();
    for (i, r) in radii.into_iter().enumerate() {
        let sunk = mass(r, 2500.0) * G / spring;
        for (height, z) in [(0.0, -0.02), (0.02, 0.06)] {
            start.push((
                DVec3::new(0.04 * i as f64 - 0.04, height + r - sunk, z),
                DVec3::ZERO,
                r,
            ));
        }
    }
    let still = scene(&file, &start);
    let step = still.time.contact_duration.unwrap() / 50.0;
    let last = frames(&stepped(still, step, 500), 1).pop().unwrap();
    for (place, (at, _, r)) in vectors(&last, "position").iter().zip(&start) {
        let sunk = mass(*r, 2500.0) * G / spring;
        println!("{r} m: off by {:.1e} of its overlap", (place.y - at.y) / sunk);
        assert!(
            (place.y - at.y).abs() < 2e-3 * sunk + 2e-9,
            "{r} m moves by {} m",
            place.y - at.y
        );
    }
    file["gravity"] = json!([0, 0, 0]);
    let mut falling = start.clone();
    for (at, v, r) in &mut falling {
        let bottom = if at.z > 0.0 { 0.02 } else { 0.0 };
        at.y = bottom + *r + 1.3 * step;
        *v = -DVec3::Y;
    }
    let scene = scene(&file, &falling);
    let step = scene.time.contact_duration.unwrap() / 100.3;
    let last = frames(&stepped(scene, step, 2400), 1).pop().unwrap();
    for (v, (.., r)) in vectors(&last, "velocity").iter().zip(&falling) {
        println!("{r} m: {:.5}", v.y);
        assert!((v.y - 0.6).abs() < 1e-3, "{r} m rebounds with {}", v.y);
    }
}

#[test]
fn neighbors_of_mixed_sizes_are_those_of_brute_force() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    for dimensions in [2, 3] {
        let mut file = empty(
            0.15,
            sized(json!({ "law": "linear", "spring": 1e3, "restitution": 0.5 })),
        );
        if dimensions == 2 {
            file["dimensions"] = json!(2);
            file["gravity"] = json!([0, 0]);
            file["domain"] = json!({ "min": [-0.15, -0.15], "max": [0.15, 0.15], "walls": "open" });
            file["bodies"][0]["shape"]["center"] = json!([0, 0]);
        }
        let mut unit = || 2.0 * rng.random::<f64>() - 1.0;
        let side = if dimensions == 2 { 0.12 } else { 0.05 };
        let grains: Vec<Grain> = (0..700)
            .map(|_| {
                let z = if dimensions == 2 { 0.0 } else { unit() };
                let place = side * DVec3::new(unit(), unit(), z);
                (place, DVec3::ZERO, R * (0.625 + 0.375 * unit()))
            })
            .collect();
        for (addressing, storage) in common::grids_in_turn(dimensions) {
            file["neighbors"] =
                json!({ "addressing": addressing.name, "storage": storage.name, "slots": 64 });
            let scene = scene(&file, &grains);
            let (x, r) = (&scene.particles.position, &scene.particles.radius);
            let beyond = scene.search_radius() - 2.0 * R;
            let mut simulation = common::simulate(&scene, &Wanted::default());
            common::frames(&mut simulation, 0);
            let found = simulation.neighbor_lists().unwrap();
            let (mut touching, mut far) = (0, 0);
            for i in 0..x.len() {
                let own = &found.ids[found.start[i] as usize..found.start[i + 1] as usize];
                for j in (0..x.len()).filter(|&j| j != i) {
                    let reach = f64::from(r[i] + r[j]) + beyond;
                    let apart = x[i].as_dvec3().distance(x[j].as_dvec3());
                    if (apart / reach - 1.0).abs() < 1e-5 {
                        continue; // by rounding, on either side
                    }
                    let is_listed = own.binary_search(&(j as u32)).is_ok();
                    assert_eq!(
                        is_listed,
                        apart < reach,
                        "{} {}: {i} and {j}",
                        addressing.name,
                        storage.name
                    );
                    touching += u32::from(is_listed);
                    far += u32::from(!is_listed && apart < scene.search_radius());
                }
            }
            println!(
                "{dimensions}D {} {}: {touching} pairs, {far} nearer than the largest reach",
                addressing.name, storage.name
            );
            assert!(touching > 500 && far > 500);
        }
    }
}
