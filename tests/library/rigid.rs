//! Rigid bodies made of grains, against closed forms in f64.

use glam::DVec3;
use serde_json::{Value, json};
use sliceflow::gpu::device::Limits;
use sliceflow::output::columns_named;
use sliceflow::physics::bodies::momenta;
use sliceflow::plan::{Plan, Wanted};
use sliceflow::scene::Scene;
use sliceflow::simulation::{Frame, Simulation, State, Values};

use crate::common;
use crate::rotating::{G, parse};

fn sound(file: &Value) -> Scene {
    parse(file).unwrap_or_else(|error| panic!("{error}"))
}

/// Bodies in open space without weight.
fn space(dimensions: usize, bodies: Value) -> Value {
    json!({
        "dimensions": dimensions,
        "domain": { "min": &[-1; 3][..dimensions], "max": &[1; 3][..dimensions], "walls": "open" },
        "gravity": &[0; 3][..dimensions],
        "grains": {
            "radius": 0.02, "density": 1000, "law": "linear", "contact_time": 2e-3, "restitution": 0.6, "friction": 0.4
        },
        "bodies": bodies,
        "time": { "duration": 0.5, "fps": 20 },
    })
}

fn wanted() -> Wanted {
    Wanted {
        statistics: true,
        columns: columns_named(["position", "velocity", "body", "contacts"]).expect("columns"),
        ..Default::default()
    }
}

fn simulation(scene: &Scene) -> Simulation {
    common::simulate(scene, &wanted())
}

fn frames(scene: &Scene, last: u32) -> Vec<Frame> {
    common::frames(&mut simulation(scene), last)
}

#[test]
fn a_collision_of_two_bodies_keeps_momenta() {
    for dimensions in [2, 3] {
        let at = |numbers: [f64; 3]| json!(&numbers[..dimensions]);
        let spin = if dimensions == 2 {
            json!([3])
        } else {
            json!([1, -2, 3])
        };
        let mut file = space(
            dimensions,
            json!([
                {
                    "shape": { "kind": "box", "min": at([-0.4, -0.1, -0.1]), "max": at([-0.1, 0.1, 0.06]) },
                    "velocity": at([1.5, 0.1, 0.0]), "rigid": { "angular_velocity": spin }
                },
                {
                    "shape": { "kind": "sphere", "center": at([0.1, 0.05, 0.02]), "radius": 0.14 },
                    "velocity": at([-0.5, 0.0, 0.1]), "rigid": { "density": 400 }, "spacing": 0.03
                },
            ]),
        );
        file["grains"]["rolling_friction"] = json!(0.1);
        let scene = sound(&file);
        let all = frames(&scene, 10);
        let [before, after] = [&all[0], &all[10]].map(|frame| momenta(&scene, &frame.bodies));
        let scale: f64 = scene
            .rigid_bodies
            .iter()
            .map(|body| body.mass * body.velocity.length())
            .sum();
        let linear = before[0].distance(after[0]) / scale;
        // Of a momentum that passes at the length of a body.
        let angular = before[1].distance(after[1]) / (0.3 * scale);
        let turned = all[0].bodies[1]
            .angular_velocity
            .distance(all[10].bodies[1].angular_velocity);
        println!(
            "{dimensions}D: linear {linear:.1e}, angular {angular:.1e}, and it turned by {turned:.2} rad/s"
        );
        assert!(turned > 0.5, "they met off their centers");
        assert!(
            linear <= 1e-6,
            "{dimensions}D: linear momentum is off by {linear:.1e}"
        );
        assert!(
            angular <= 1e-5,
            "{dimensions}D: angular momentum is off by {angular:.1e}"
        );
    }
}

#[test]
fn a_body_that_tumbles_keeps_angular_momentum_and_energy() {
    // About its middle axis, which is not stable.
    let file = space(
        3,
        json!([{
            "shape": { "kind": "box", "min": [-0.2, -0.1, -0.05], "max": [0.2, 0.1, 0.05] },
            "velocity": [0.1, 0.2, -0.1], "rigid": { "angular_velocity": [0.02, 9.0, 0.01] }
        }]),
    );
    let mut scene = sound(&file);
    scene.time.frames = 41;
    let all = frames(&scene, 40);
    let start = momenta(&scene, &all[0].bodies)[1]
        - all[0].bodies[0].center.cross(momenta(&scene, &all[0].bodies)[0]);
    let mut most_turned = 1.0f64;
    for frame in &all {
        let motion = frame.bodies[0];
        let [linear, angular] = momenta(&scene, &frame.bodies);
        let own = angular - motion.center.cross(linear);
        let off = own.distance(start) / start.length();
        assert!(
            off < 1e-5,
            "frame {}: angular momentum is off by {off:.1e}",
            frame.index
        );
        let energy = frame.statistics.unwrap().kinetic_energy;
        let off = energy / all[0].statistics.unwrap().kinetic_energy - 1.0;
        assert!(
            off.abs() < 1e-5,
            "frame {}: energy is off by {off:.1e}",
            frame.index
        );
        most_turned = most_turned.min((motion.orientation * DVec3::Y).y);
        assert!(motion.center.distance(frame.time * DVec3::new(0.1, 0.2, -0.1)) < 1e-6);
    }
    assert!(most_turned < -0.9, "its middle axis turned over: {most_turned}");
}

#[test]
fn particles_stay_where_they_are_in_their_body() {
    let file = space(
        3,
        json!([
            { "shape": { "kind": "sphere", "center": [-0.6, 0, 0], "radius": 0.1 } },
            {
                "shape": { "kind": "box", "min": [-0.2, -0.1, -0.05], "max": [0.2, 0.1, 0.05] },
                "velocity": [0.1, 0.2, -0.1], "rigid": { "angular_velocity": [3.0, 5.0, -4.0] }
            },
        ]),
    );
    let mut scene = sound(&file);
    scene.time.frames = 21;
    let last = frames(&scene, 20).pop().unwrap();
    let vectors = |name: &str| -> Vec<DVec3> {
        let column = last.columns.iter().find(|column| column.name == name).unwrap();
        let values: Vec<f64> = match &column.values {
            Values::Double { values, .. } => values.clone(),
            Values::Vector { values, .. } => values.iter().map(|&v| v.into()).collect(),
            _ => unreachable!(),
        };
        values.chunks_exact(3).map(DVec3::from_slice).collect()
    };
    let (position, velocity) = (vectors("position"), vectors("velocity"));
    let (body, motion) = (&scene.rigid_bodies[0], last.bodies[0]);
    for (k, place) in body.places.iter().enumerate() {
        let id = body.first as usize + k;
        let arm = motion.orientation * *place;
        assert!(position[id].distance(motion.center + arm) < 1e-6);
        let known = motion.velocity + motion.angular_velocity.cross(arm);
        assert!(velocity[id].distance(known) < 1e-5, "{} {known}", velocity[id]);
    }
    let Values::Unsigned(bodies) = &last
        .columns
        .iter()
        .find(|column| column.name == "body")
        .unwrap()
        .values
    else {
        panic!("numbers of bodies are whole numbers")
    };
    let first = body.first as usize;
    assert!(
        bodies[..first].iter().all(|&number| number == 0)
            && bodies[first..].iter().all(|&number| number == 1)
    );
    // The loose ball of grains has no contact within itself, and the body counts none.
    let Values::Unsigned(contacts) = &last
        .columns
        .iter()
        .find(|column| column.name == "contacts")
        .unwrap()
        .values
    else {
        panic!("contacts are counted")
    };
    assert!(contacts[first..].iter().all(|&contacts| contacts == 0));
}

/// How a covered ball speeds up down a plane, over 5/7 g sin θ.
fn rolled(restitution: f64) -> f64 {
    let (radius, slope) = (0.2, 20f64.to_radians());
    let file = json!({
        "domain": { "min": [-0.5, 0, -0.5], "max": [2.5, 1, 0.5], "walls": "open", "sides": { "y_min": "contact" } },
        "gravity": [G * slope.sin(), -G * slope.cos(), 0],
        "grains": {
            "radius": 0.02, "density": 1000, "law": "linear", "spring": 1e5, "restitution": restitution, "friction": 0.8
        },
        "bodies": [{
            "shape": { "kind": "sphere", "center": [0, radius, 0], "radius": radius }, "spacing": 0.02, "rigid": {}
        }],
        "time": { "duration": 0.5, "fps": 20 },
    });
    let scene = sound(&file);
    let all = frames(&scene, 10);
    // By its angular momentum about the contact, 7/5 R v where it rolls: it bounces a little, and then slides to and fro.
    let speed = |frame: usize| {
        let body = all[frame].bodies[0];
        (body.velocity.x - 0.4 * radius * body.angular_velocity.z) / 1.4
    };
    let time = |frame: usize| all[frame].time;
    let turned = -all[10].bodies[0].angular_velocity.z * radius / speed(10);
    assert!((turned - 1.0).abs() < 0.1, "it rolls: {turned}");
    (speed(10) - speed(2)) / (time(10) - time(2)) / (5.0 / 7.0 * G * slope.sin())
}

#[test]
fn a_ball_of_particles_rolls_down_a_slope() {
    // Its particles are bumps. Where they lose nothing it rolls as a smooth ball does.
    let elastic = rolled(1.0);
    println!("{elastic:.4}");
    assert!((elastic - 1.0).abs() < 0.01, "{elastic}");
}

/// Bodies and loose grains that fall into a box.
fn heap(dimensions: usize) -> Value {
    let at = |numbers: [f64; 3]| json!(&numbers[..dimensions]);
    let counts = [2, 2, 2];
    // A disc one metre thick weighs more than a ball.
    let spring = if dimensions == 2 { 1e6 } else { 3e4 };
    json!({
        "dimensions": dimensions,
        "domain": { "min": at([-0.25, 0.0, -0.2]), "max": at([0.25, 0.8, 0.2]) },
        "gravity": at([0.0, -G, 0.0]),
        "grains": {
            "radius": 0.02, "density": 1000, "law": "linear", "spring": spring, "restitution": 0.3, "friction": 0.5,
            "rolling_friction": 0.1
        },
        "bodies": [
            { "shape": { "kind": "box", "min": at([-0.2, 0.0, -0.1]), "max": at([0.2, 0.1, 0.1]) }, "jitter": 0.01, "spacing": 0.042 },
            {
                "shape": { "kind": "box", "min": at([-0.17, 0.25, -0.13]), "max": at([-0.05, 0.33, -0.05]) },
                "rigid": { "copies": {
                    "counts": &counts[..dimensions], "step": at([0.2, 0.2, 0.16]), "random_rotation": true
                } }
            },
        ],
        "time": { "duration": 2, "fps": 20, "steps_per_contact": 25 },
    })
}

#[test]
fn a_heap_of_bodies_comes_to_rest() {
    for dimensions in [2, 3] {
        let mut file = heap(dimensions);
        file["time"]["fps"] = json!(2);
        let all = frames(&sound(&file), 4);
        let fastest = |frame: &Frame| {
            let speeds = frame.bodies.iter().map(|body| body.velocity.length());
            speeds.fold(0.0, f64::max)
        };
        println!("{dimensions}D: {:?}", all.iter().map(fastest).collect::<Vec<_>>());
        let bar = 1e-3 * (G * 0.04).sqrt();
        assert!(fastest(&all[4]) < bar, "{dimensions}D: {} m/s", fastest(&all[4]));
        let overlap = all[4].statistics.unwrap().max_overlap;
        assert!(overlap < 0.1, "{dimensions}D: {overlap}");
    }
}

#[test]
fn a_run_that_goes_on_has_the_same_bytes() {
    for (dimensions, skin) in [(2, 0.1), (3, 0.1), (3, 0.0)] {
        let mut file = heap(dimensions);
        file["neighbors"] = json!({ "skin": skin });
        let scene = sound(&file);
        let (middle, last) = (5, 8);
        let end = |simulation: &mut Simulation| -> State {
            common::frames(simulation, last);
            simulation.save_state().expect("a state")
        };
        let mut first = simulation(&scene);
        common::frames(&mut first, middle);
        let state = first.save_state().expect("a state");
        assert!(state.buffer("body_state").is_some() && state.buffer("body").is_some());
        let mut second = simulation(&scene);
        second.restore(&state).expect("restored");
        assert!(
            second.save_state().expect("a state") == state,
            "restoring changes the state"
        );
        let whole = end(&mut first);
        assert!(
            end(&mut second) == whole,
            "{dimensions}D, skin {skin}: the end differs"
        );
        assert!(
            end(&mut simulation(&scene)) == whole,
            "{dimensions}D: runs differ"
        );
        let mut other = file.clone();
        other["bodies"][1]["rigid"]["copies"]["counts"][0] = json!(1);
        let refused = simulation(&sound(&other))
            .restore(&state)
            .unwrap_err()
            .to_string();
        assert!(
            refused.contains("rigid bodies are others") || refused.contains("body_state"),
            "{refused}"
        );
    }
}

#[test]
fn what_rigid_bodies_do_not_know_is_refused() {
    let body =
        json!({ "shape": { "kind": "box", "min": [-0.2, -0.1, -0.1], "max": [0.2, 0.1, 0.1] }, "rigid": {} });
    let sound = space(3, json!([body]));
    assert!(parse(&sound).is_ok());
    let old = json!({ "radius": 0.02, "spring": 100, "restitution": 0.5 });
    for (path, value, expected) in [
        ("/bodies/0/rigid/density", json!(-1), "out of range"),
        ("/bodies/0/jitter", json!(0.1), "stand in order"),
        ("/bodies/0/arrangement", json!("random"), "stand in order"),
        ("/bodies/0/spacing", json!(0.01), "less than a particle's radius"),
        ("/bodies/0/spacing", json!(0.05), "would leave gaps"),
        (
            "/bodies/0/shape/min",
            json!([0.16, 0.06, 0.06]),
            "one particle, which is a grain",
        ),
        ("/bodies/0/shape/min", json!([0.19, 0, 0]), "is empty"),
        (
            "/bodies/0/rigid/angular_velocity",
            json!([1]),
            "1 numbers in a 3D scene",
        ),
        (
            "/bodies/0/rigid/copies",
            json!({ "counts": [300, 300, 2], "step": [1, 1, 1] }),
            "too many rigid bodies",
        ),
        (
            "/bodies/0/rigid/copies",
            json!({ "counts": [2, 0, 1], "step": [1, 1, 1] }),
            "at least 1",
        ),
        (
            "/bodies/0/rigid/copies",
            json!({ "counts": [2, 1, 1], "step": [0.1, 0, 0] }),
            "overlaps bodies[0]",
        ),
        (
            "/bodies/0/rigid/copies",
            json!({ "counts": [2, 1, 1], "step": [0.3, 0, 0] }),
            "to others",
        ),
        (
            "/domain/walls",
            json!("periodic"),
            "cannot have this kind of wall",
        ),
        ("/time/adaptive", json!(true), "how fast rigid bodies turn"),
        ("/grains", old, "set grains.law to `linear`"),
        ("/bodies/0/rigid/color", json!("#ff0000"), "drawn one by one"),
        (
            "/emitters",
            json!([{ "name": "spout", "center": [0, 0.5, 0], "radius": 0.1, "velocity": [0, -1, 0], "rigid": {} }]),
            "unknown key",
        ),
    ] {
        let mut file = sound.clone();
        match file.pointer_mut(path) {
            Some(place) => *place = value.clone(),
            None => {
                let (parent, key) = path.rsplit_once('/').unwrap();
                file.pointer_mut(parent).unwrap()[key] = value.clone();
            }
        }
        match parse(&file) {
            Ok(_) => panic!("{path} = {value} is accepted"),
            Err(error) => assert!(error.to_string().contains(expected), "{path}: {error}"),
        }
    }
}

#[test]
fn what_no_scene_asks_for_costs_nothing() {
    let mut loose = heap(3);
    loose["bodies"].as_array_mut().unwrap().pop();
    let names = |file: &Value| -> (Vec<String>, u32) {
        let plan = Plan::new(&sound(file), &Limits::PROMISED, &wanted_less()).expect("a plan");
        let passes = plan.passes.iter().map(|row| row.pass.shader.clone());
        let buffers = plan.buffers.iter().map(|buffer| buffer.name.clone());
        let is_own = |name: &String| ["bod", "member"].iter().any(|own| name.contains(own));
        (
            passes.chain(buffers).filter(is_own).collect(),
            plan.most_storage_buffers().1,
        )
    };
    assert_eq!(names(&loose).0, Vec::<String>::new());
    let (own, bound) = names(&heap(3));
    assert!(own.len() >= 8, "{own:?}");
    assert!(bound <= 8, "a pass binds {bound} storage buffers");
}

fn wanted_less() -> Wanted {
    Wanted {
        statistics: true,
        ..Default::default()
    }
}
