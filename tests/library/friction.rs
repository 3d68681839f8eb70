//! Grains that rotate and rub, against closed forms in f64.

use std::f64::consts::PI;

use glam::DVec3;
use serde_json::{Value, json};
use sliceflow::gpu::device::Limits;
use sliceflow::output::columns_named;
use sliceflow::plan::{Plan, Wanted};
use sliceflow::scene::Scene;
use sliceflow::simulation::{Frame, State};

use crate::common;
use crate::rotating::{G, empty, floor, frames, mass, parse, scene, stepped, vectors};

#[test]
fn linear_collisions_give_back_what_was_asked_for() {
    // Sixteen pairs, which touch and part at different parts of a step: a contact lasts 50.3 of them.
    let radius = 0.01;
    for restitution in [0.3, 0.5, 0.7, 0.9, 1.0] {
        let file = empty(
            1.0,
            json!({ "radius": radius, "law": "linear", "contact_time": 1e-3, "restitution": restitution }),
        );
        let (speed, step) = (0.5, 1e-3 / 50.3);
        let mut particles = Vec::new();
        for pair in 0..16 {
            let gap = 2.0 * speed * step * (1.0 + f64::from(pair) / 16.0);
            let center = DVec3::new(0.0, 0.1 * f64::from(pair % 4), 0.1 * f64::from(pair / 4));
            let half = DVec3::X * (radius + gap / 2.0);
            particles.extend([
                (center - half, DVec3::X * speed),
                (center + half, -DVec3::X * speed),
            ]);
        }
        let last = frames(&stepped(scene(&file, &particles), step, 80), 1)
            .pop()
            .unwrap();
        let after = vectors(&last, "velocity");
        let worst = after
            .chunks(2)
            .map(|pair| ((pair[1].x - pair[0].x) / (2.0 * speed) - restitution).abs())
            .fold(0.0, f64::max);
        println!("e = {restitution}: off by {worst:.1e}");
        assert!(worst <= 1e-3, "e = {restitution}: off by {worst:.1e}");
        assert_eq!(last.statistics.unwrap().contacts, 0);
    }
}

#[test]
fn an_elastic_impact_is_that_of_hertz() {
    // Chung and Ooi 2011, test 1: two glass spheres. The closed form is `dem_hertz_closed_form` of the reference data.
    let (radius, speed) = (0.01, 10.0);
    let (deepest, duration) = (0.000_274_112_7, 4.033_945e-5);
    let file = empty(
        0.1,
        json!({
            "radius": radius, "density": 2800, "law": "hertz", "young_modulus": 48e9, "poisson_ratio": 0.2,
            "restitution": 1, "friction": 0
        }),
    );
    let step = duration / 100.3;
    let gap = 2.0 * speed * step * 1.4;
    let half = DVec3::X * (radius + gap / 2.0);
    let particles = [(-half, DVec3::X * speed), (half, -DVec3::X * speed)];
    let all = frames(&stepped(scene(&file, &particles), step, 1), 120);
    let overlap = all
        .iter()
        .map(|frame| frame.statistics.unwrap().max_overlap * radius)
        .fold(0.0, f64::max);
    let last = all.last().unwrap();
    let (x, v) = (vectors(last, "position")[1].x, vectors(last, "velocity")[1].x);
    let back = v / speed;
    // Since it touched: as long as the impact, and the way back from there.
    let time = 120.0 * step - gap / (2.0 * speed);
    let found = time - (x - radius) / v;
    println!(
        "overlap {:.1e}, duration {:.1e}, restitution {:.1e}",
        overlap / deepest - 1.0,
        found / duration - 1.0,
        back - 1.0
    );
    assert!((overlap / deepest - 1.0).abs() < 1e-3);
    assert!((found / duration - 1.0).abs() < 1e-3);
    assert!((back - 1.0).abs() < 1e-3);
}

#[test]
fn oblique_impacts_that_slide_follow_the_closed_form() {
    // Chung and Ooi 2011, test 4: alumina on a rigid plane. Beyond some 30° from the normal it slides to the end: then
    // e_t = 1 − μ(1 + e)/tan θ and ω = 5μ(1 + e) v_n/(2R).
    let (radius, speed, mu, e) = (2.5e-3, 3.9, 0.092, 0.98);
    let file = floor(
        0.02,
        [0.0; 3],
        json!({
            "radius": radius, "density": 4000, "law": "hertz", "young_modulus": 380e9, "poisson_ratio": 0.23,
            "restitution": e, "friction": mu
        }),
    );
    let angles = [30.0, 40.0, 50.0, 60.0f64];
    let particles: Vec<(DVec3, DVec3)> = angles
        .iter()
        .enumerate()
        .map(|(i, angle)| {
            let (sin, cos) = angle.to_radians().sin_cos();
            let z = 0.008 * (i as f64 - 1.5);
            (
                DVec3::new(0.0, radius * 1.002, z),
                speed * DVec3::new(sin, -cos, 0.0),
            )
        })
        .collect();
    let scene = scene(&file, &particles);
    let step = scene.time.contact_duration.unwrap() / 50.0;
    let last = frames(&stepped(scene, step, 400), 1).pop().unwrap();
    assert_eq!(last.statistics.unwrap().contacts, 0);
    let (after, spins) = (vectors(&last, "velocity"), vectors(&last, "angular_velocity"));
    for (i, angle) in angles.iter().enumerate() {
        let theta = angle.to_radians();
        let tangential = after[i].x / (speed * theta.sin());
        let expected = 1.0 - mu * (1.0 + e) / theta.tan();
        let spin = 5.0 * mu * (1.0 + e) * speed * theta.cos() / (2.0 * radius);
        println!(
            "{angle}°: e_t {tangential:.5} for {expected:.5}, spin {:.3} for {:.3}",
            spins[i].z, -spin
        );
        assert!((tangential / expected - 1.0).abs() < 5e-3);
        assert!((spins[i].z / -spin - 1.0).abs() < 5e-3);
        assert!((after[i].y / (speed * theta.cos()) - e).abs() < 2e-3);
    }
}

#[test]
fn a_sliding_sphere_comes_to_roll() {
    let (radius, speed, mu) = (0.05, 1.0, 0.3);
    let grains = json!({
        "radius": radius, "density": 2500, "law": "linear", "contact_time": 4e-3, "restitution": 0.5, "friction": mu
    });
    let file = floor(0.5, [0.0, -G, 0.0], grains);
    let still = scene(&file, &[]);
    let spring = still.friction().unwrap().walls.stiffness;
    let sunk = mass(radius, 2500.0) * G / spring;
    let rolls = 2.0 * speed / (7.0 * mu * G);
    // Frames of a tenth of the time until it rolls.
    let step = rolls / 1000.0;
    let begin = (DVec3::new(-0.3, radius - sunk, 0.0), DVec3::X * speed);
    let all = frames(&stepped(scene(&file, &[begin]), step, 100), 15);
    // Where it slides, its speed falls evenly: the slope, and where it meets the speed of rolling, give the time.
    let speeds: Vec<f64> = all.iter().map(|frame| vectors(frame, "velocity")[0].x).collect();
    let slope = (speeds[9] - speeds[1]) / (800.0 * step);
    let last = speeds[15];
    let time = 900.0 * step + (last - speeds[9]) / slope;
    let spin = vectors(&all[15], "angular_velocity")[0].z;
    println!(
        "rolls after {:.1e}, at {:.1e}, without slip {:.1e}",
        time / rolls - 1.0,
        last / (5.0 / 7.0 * speed) - 1.0,
        -spin * (radius - sunk) / last - 1.0
    );
    assert!((time / rolls - 1.0).abs() < 1e-3);
    assert!((last / (5.0 / 7.0 * speed) - 1.0).abs() < 1e-3);
    assert!((-spin * (radius - sunk) / last - 1.0).abs() < 1e-3);
}

#[test]
fn a_stack_of_ten_carries_its_weight_and_does_not_creep() {
    let (radius, n) = (0.01, 10);
    let file = floor(
        0.15,
        [0.0, -G, 0.0],
        json!({ "radius": radius, "law": "linear", "spring": 2000, "restitution": 0.3 }),
    );
    let weight = mass(radius, 2500.0) * G;
    // As the closed form has it, where it stays.
    let mut top = -radius;
    let particles: Vec<_> = (0..n)
        .map(|i| {
            top += 2.0 * radius - f64::from(n - i) * weight / 2000.0;
            (DVec3::Y * top, DVec3::ZERO)
        })
        .collect();
    let scene = scene(&file, &particles);
    let step = scene.time.contact_duration.unwrap() / 40.0;
    let all = frames(&stepped(scene, step, 2000), 3);
    let heights = |frame: &Frame| -> Vec<f64> { vectors(frame, "position").iter().map(|p| p.y).collect() };
    let (then, now) = (heights(&all[2]), heights(&all[3]));
    let mut below = -radius;
    for (i, &height) in now.iter().enumerate() {
        let overlap = 2.0 * radius - (height - below);
        let expected = f64::from(n - i as i32) * weight / 2000.0;
        println!("{i}: {:.1e}", overlap / expected - 1.0);
        assert!(
            (overlap / expected - 1.0).abs() < 1e-3,
            "contact {i}: {overlap} for {expected}"
        );
        assert!((height - then[i]).abs() < 1e-4 * expected, "grain {i} creeps");
        below = height;
    }
}

#[test]
fn an_oblique_collision_keeps_momentum_and_angular_momentum() {
    let radius = 0.01;
    for (dimensions, law) in [
        (
            3,
            json!({ "radius": radius, "law": "linear", "contact_time": 1e-3, "restitution": 0.6, "rolling_friction": 0.2 }),
        ),
        (
            3,
            json!({ "radius": radius, "law": "hertz", "young_modulus": 1e7, "restitution": 0.6 }),
        ),
        (
            2,
            json!({ "radius": radius, "law": "linear", "contact_time": 1e-3, "restitution": 0.6, "rolling_friction": 0.2 }),
        ),
    ] {
        let mut file = empty(0.1, law);
        let mut off = DVec3::new(0.006, 0.011, 0.0165);
        let mut pushed = DVec3::new(-0.1, -1.0, -1.0);
        if dimensions == 2 {
            file["dimensions"] = json!(2);
            file["domain"] = json!({ "min": [-0.1, -0.1], "max": [0.1, 0.1], "walls": "open" });
            file["gravity"] = json!([0, 0]);
            file["bodies"][0]["shape"]["center"] = json!([0, 0]);
            (off, pushed) = (DVec3::new(0.012, 0.0165, 0.0), DVec3::new(0.1, -1.0, 0.0));
        }
        let scene = scene(&file, &[(DVec3::ZERO, DVec3::ZERO), (off, pushed)]);
        let inertia = scene.friction().unwrap().inertia / scene.grains().unwrap().mass;
        let duration = scene.time.contact_duration.unwrap();
        let all = frames(&stepped(scene, duration / 50.0, 200), 2);
        let of = |frame: &Frame| {
            let (x, v) = (vectors(frame, "position"), vectors(frame, "velocity"));
            let w = vectors(frame, "angular_velocity");
            let turning: DVec3 = (0..2).map(|i| x[i].cross(v[i]) + inertia * w[i]).sum();
            (v[0] + v[1], turning, w[0])
        };
        let (before, after) = (of(&all[0]), of(&all[2]));
        assert_eq!(all[2].statistics.unwrap().contacts, 0);
        assert!(after.2.length() > 1.0, "it rubbed: {}", after.2);
        let linear = before.0.distance(after.0) / before.0.length();
        // Over what one of the grains alone has about the other's center.
        let angular = before.1.distance(after.1) / before.1.length();
        println!("{dimensions}D: momentum {linear:.1e}, angular momentum {angular:.1e}");
        assert!(linear < 1e-6, "momentum {linear:.1e}");
        assert!(angular < 1e-5, "angular momentum {angular:.1e}");
    }
}

#[test]
fn a_grain_holds_on_a_slope_below_the_angle_of_friction_and_leaves_one_above() {
    let radius = 0.01;
    for (rolling, law) in [
        ("spring", json!({ "law": "linear", "spring": 2000 })),
        ("spring", json!({ "law": "hertz", "young_modulus": 1e7 })),
    ] {
        for (angle, holds) in [(20.0f64, true), (30.0, false)] {
            let mut grains = law.clone();
            grains["radius"] = radius.into();
            grains["restitution"] = 0.5.into();
            // It slides beyond 26.6°, and rolls beyond 35°.
            grains["friction"] = 0.5.into();
            grains["rolling_friction"] = 0.7.into();
            grains["rolling_resistance"] = rolling.into();
            let (sin, cos) = angle.to_radians().sin_cos();
            let file = floor(0.2, [G * sin, -G * cos, 0.0], grains);
            let scene = scene(&file, &[(DVec3::new(-0.1, radius * 0.999, 0.0), DVec3::ZERO)]);
            let step = scene.time.contact_duration.unwrap() / 40.0;
            let steps = (0.1 / step).ceil() as u32;
            let all = frames(&stepped(scene, step, steps), 4);
            let at = |frame: usize| vectors(&all[frame], "position")[0].x;
            let crept = at(4) - at(3);
            println!("{angle}°: {crept:.1e} m in the last quarter");
            if holds {
                assert!(crept.abs() < 2e-5 * radius, "{angle}°: crept by {crept:.1e} m");
            } else {
                // It is faster by g (sin θ − μ cos θ) times a quarter of the time.
                let time = step * f64::from(steps);
                let found = (crept - (at(3) - at(2))) / (time * time);
                let expected = G * (sin - 0.5 * cos);
                println!("acceleration {:.1e}", found / expected - 1.0);
                assert!(
                    (found / expected - 1.0).abs() < 5e-3,
                    "{found} m/s² for {expected}"
                );
            }
        }
    }
}

/// A few discs or balls that pour onto a floor.
fn pour(dimensions: usize, more: &[(&str, Value)]) -> Value {
    // Grains sink by a thousandth of their size under their own weight: a disc is one metre thick.
    let spring = if dimensions == 2 { 7.5e5 } else { 2e4 };
    let mut grains = json!({
        "radius": 0.02, "law": "linear", "spring": spring, "restitution": 0.4, "friction": 0.5, "rolling_friction": 0.3
    });
    for (key, value) in more {
        grains[*key] = value.clone();
    }
    let cut = |numbers: [f64; 3]| json!(numbers[..dimensions]);
    json!({
        "dimensions": dimensions,
        "domain": { "min": cut([-0.3, 0.0, -0.1]), "max": cut([0.3, 0.5, 0.1]) },
        "gravity": cut([0.0, -G, 0.0]),
        "grains": grains,
        "bodies": [{
            "shape": { "kind": "box", "min": cut([-0.09, 0.02, -0.09]), "max": cut([0.09, 0.2, 0.09]) },
            "spacing": 0.0402, "jitter": 0.05
        }],
        "colliders": [{ "shape": { "kind": "sphere", "center": cut([0.05, 0.0, 0.0]), "radius": 0.05 } }],
        "events": [{ "at": 0.05, "drop": { "center": cut([-0.1, 0.35, 0.0]), "radius": 0.05 } }],
        "time": { "duration": 0.2, "fps": 40 }
    })
}

#[test]
fn a_run_that_goes_on_has_the_same_bytes() {
    for (dimensions, more, grid) in [
        (2, vec![], json!({})),
        (3, vec![], json!({})),
        (
            3,
            vec![("rolling_friction", json!(0))],
            json!({ "storage": "pool", "slots": 8 }),
        ),
        (
            3,
            vec![("rolling_resistance", json!("constant_torque"))],
            json!({ "skin": 0 }),
        ),
    ] {
        let mut file = pour(dimensions, &more);
        file["neighbors"] = grid;
        let scene = parse(&file).unwrap_or_else(|error| panic!("{error}"));
        let wanted = Wanted {
            statistics: true,
            columns: columns_named(["position", "velocity", "angular_velocity", "pressure"]).unwrap(),
            ..Default::default()
        };
        let mut through = common::simulate(&scene, &wanted);
        let whole = common::frames(&mut through, 8);
        let mut first = common::simulate(&scene, &wanted);
        common::frames(&mut first, 4);
        let state: State = first.save_state().unwrap();
        assert!(
            state
                .buffer("contact_history")
                .is_some_and(|bytes| bytes.iter().any(|&b| b != 0))
        );
        let mut second = common::simulate(&scene, &wanted);
        second.restore(&state).unwrap();
        assert!(
            second.save_state().unwrap() == state,
            "restoring changes the state"
        );
        let rest = common::frames(&mut second, 8);
        for (one, two) in rest.iter().zip(&whole[5..]) {
            assert_eq!(one.index, two.index);
            assert_eq!(
                one.columns, two.columns,
                "{dimensions}D, {more:?}, frame {}",
                one.index
            );
            assert_eq!(one.statistics, two.statistics);
        }
        assert!(second.save_state().unwrap() == through.save_state().unwrap());
    }
}

#[test]
fn a_run_goes_on_with_friction_that_it_did_not_have() {
    let smooth = pour(2, &[]);
    let mut slippery = smooth.clone();
    slippery["grains"] = json!({ "radius": 0.02, "spring": 7.5e5, "restitution": 0.4 });
    let mut first = common::simulate(&parse(&slippery).unwrap(), &Wanted::default());
    common::frames(&mut first, 4);
    let mut second = common::simulate(&parse(&smooth).unwrap(), &Wanted::default());
    second.restore(&first.save_state().unwrap()).unwrap();
    common::frames(&mut second, 8);
    let state = second.save_state().unwrap();
    // Each grain has its key, and contacts remember it.
    let spins: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(state.buffer("angular_velocity").unwrap());
    for (id, spin) in state.ids().iter().zip(&spins) {
        assert_eq!(spin[3], (id + 1) as f32);
    }
    assert!(spins.iter().any(|spin| spin[2] != 0.0));
}

#[test]
fn a_heap_stands_still() {
    let mut file = pour(2, &[]);
    file["time"] = json!({ "duration": 3, "fps": 1 });
    let scene = parse(&file).unwrap_or_else(|error| panic!("{error}"));
    let last = frames(&scene, 3).pop().unwrap();
    let still = (G * 2.0 * scene.radius()).sqrt();
    let speed = last.statistics.unwrap().max_speed / still;
    println!("fastest: {speed:.1e} √(g d)");
    assert!(speed < 1e-4, "{speed:.1e}");
    let highest = vectors(&last, "position")
        .iter()
        .fold(0.0, |y: f64, p| y.max(p.y));
    assert!(highest > 3.0 * scene.radius(), "it has no third layer: {highest}");
}

#[test]
fn more_contacts_than_there_is_room_for_are_told() {
    let file = empty(
        0.5,
        json!({ "radius": 0.05, "law": "linear", "contact_time": 1e-2, "restitution": 0.5 }),
    );
    let crowd: Vec<_> = (0..30)
        .map(|i| {
            let angle = f64::from(i);
            (
                0.02 * DVec3::new(angle.sin(), angle.cos(), (1.7 * angle).sin()),
                DVec3::ZERO,
            )
        })
        .collect();
    let scene = stepped(scene(&file, &crowd), 1e-4, 2);
    let mut simulation = common::simulate(&scene, &Wanted::default());
    let mut frame = || simulation.next_frame().and_then(|_| simulation.finish_frame());
    let error = frame()
        .and_then(|_| frame())
        .expect_err("too many contacts")
        .to_string();
    assert!(
        error.contains("touches more") && error.contains("grains.spring"),
        "{error}"
    );
}

#[test]
fn what_a_law_does_not_know_or_lacks_is_told() {
    let problems = |grains: Value, more: &[(&str, Value)]| {
        let mut file = empty(1.0, grains);
        for (key, value) in more {
            file[*key] = value.clone();
        }
        parse(&file).expect_err("a problem").to_string()
    };
    for (grains, expected) in [
        (
            json!({ "radius": 0.1, "spring": 1, "restitution": 0.5, "friction": 0.5 }),
            "grains.friction",
        ),
        (json!({ "radius": 0.1, "restitution": 0.5 }), "grains.spring"),
        (
            json!({ "radius": 0.1, "law": "linear", "restitution": 0.5 }),
            "contact_time",
        ),
        (
            json!({ "radius": 0.1, "law": "linear", "spring": 1 }),
            "grains.restitution",
        ),
        (
            json!({ "radius": 0.1, "law": "linear", "spring": 1, "contact_time": 1, "restitution": 0.5 }),
            "remove one of them",
        ),
        (
            json!({ "radius": 0.1, "law": "linear", "spring": 1, "restitution": 0.5, "shear": 1 }),
            "grains.shear",
        ),
        (
            json!({ "radius": 0.1, "law": "hertz", "restitution": 0.5 }),
            "grains.young_modulus",
        ),
        (
            json!({ "radius": 0.1, "law": "hertz", "young_modulus": 1e7, "restitution": 0.5, "spring": 1 }),
            "grains.spring",
        ),
        (
            json!({
                "radius": 0.1, "law": "linear", "spring": 1, "restitution": 0.5, "rolling_resistance": "spring"
            }),
            "rolling_friction",
        ),
    ] {
        let text = problems(grains.clone(), &[]);
        assert!(text.contains(expected), "{grains}: {text}");
    }
    let linear = json!({ "radius": 0.1, "law": "linear", "spring": 1, "restitution": 0.5 });
    let euler = json!({ "duration": 1, "fps": 1, "integrator": "symplectic_euler" });
    assert!(problems(linear.clone(), &[("time", euler)]).contains("velocity Verlet"));
    let clamp = json!({ "min": [-1, -1, -1], "max": [1, 1, 1], "walls": "clamp" });
    assert!(problems(linear.clone(), &[("domain", clamp)]).contains("no friction"));
    let long = json!({ "duration": 1, "fps": 1, "step": 10 });
    assert!(problems(linear, &[("time", long)]).contains("too long"));
}

#[test]
fn contact_time_and_spring_say_the_same() {
    let by = |key: &str, value: f64| {
        let mut grains = json!({ "radius": 0.01, "law": "linear", "restitution": 0.4 });
        grains[key] = value.into();
        parse(&empty(1.0, grains)).unwrap().friction().unwrap().grains
    };
    let timed = by("contact_time", 1e-3);
    let sprung = by("spring", timed.stiffness);
    assert!((timed.damping / sprung.damping - 1.0).abs() < 1e-12);
    let half = mass(0.01, 2500.0) / 2.0;
    let beta = timed.damping / (2.0 * (timed.stiffness * half).sqrt());
    let duration = PI / ((timed.stiffness / half).sqrt() * (1.0 - beta * beta).sqrt());
    assert!((duration / 1e-3 - 1.0).abs() < 1e-12, "{duration}");
}

#[test]
fn what_no_scene_asks_for_costs_nothing() {
    let remembers = |scene: &Scene| {
        let plan = Plan::new(scene, &Limits::PROMISED, &Wanted::default()).expect("a plan");
        let buffers = plan.buffers.iter().map(|buffer| buffer.name.as_str());
        let own = [
            "contact_history",
            "contact_acceleration",
            "angular_velocity",
            "half_step",
        ];
        let found: Vec<_> = buffers
            .filter(|name| own.iter().any(|own| name.ends_with(own)))
            .collect();
        (found.len(), plan.most_storage_buffers().1)
    };
    assert_eq!(remembers(&common::scene(3, &[])).0, 0);
    let (own, bound) = remembers(&parse(&pour(3, &[])).unwrap());
    assert_eq!(own, 7, "two of each, and the accelerations");
    assert!(bound <= 8, "a pass binds {bound} storage buffers");
}
