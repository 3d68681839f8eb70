//! Rigid bodies in a fluid: Archimedes, momenta, and the same bytes in every run.

use std::path::Path;

use glam::DVec3;
use serde_json::{Value, json};
use sliceflow::error::Error;
use sliceflow::gpu::device::Limits;
use sliceflow::physics::bodies::{BodyMotion, momenta};
use sliceflow::plan::{Plan, Wanted};
use sliceflow::scene::{Particles, Scene, load};
use sliceflow::simulation::{Frame, Simulation, State};

use crate::common;

const G: f64 = 9.81;
const DENSITY: f64 = 1000.0;

fn parse(file: &Value) -> Result<Scene, Error> {
    load::parse(&file.to_string(), "test.json", Path::new("."), &[])
}

fn sound(file: &Value) -> Scene {
    parse(file).unwrap_or_else(|error| panic!("{error}"))
}

fn wanted() -> Wanted {
    Wanted {
        statistics: true,
        ..Default::default()
    }
}

fn run(scene: &Scene, last: u32) -> (Simulation, Vec<Frame>) {
    let mut simulation = common::simulate(scene, &wanted());
    let frames = common::frames(&mut simulation, last);
    (simulation, frames)
}

/// A tank of water in 2D with what is in it.
fn tank(size: [f64; 2], depth: f64, spacing: f64, viscosity: f64, bodies: &[Value]) -> Value {
    let water = json!({ "shape": { "kind": "box", "min": [0, 0], "max": [size[0], depth] }, "pressure": "hydrostatic" });
    let all = [&[water], bodies].concat();
    json!({
        "dimensions": 2,
        "domain": { "min": [0, 0], "max": size },
        "gravity": [0, -G],
        "fluid": { "spacing": spacing, "density": DENSITY, "viscosity": viscosity },
        "bodies": all,
        "time": { "duration": 10, "fps": 10 },
    })
}

#[test]
fn a_light_box_floats_upright_as_archimedes_says() {
    let (width, height, tank_width, spacing) = (0.28, 0.2, 0.84, 0.02);
    let mut far = Vec::new();
    // One begins as it floats; one is let go higher, and turning.
    for (density, higher, spin, bar) in [(500.0, 0.0, 0.0, 0.005), (300.0, 0.03, 1.0, 0.02)] {
        let bottom = 0.32 - density / DENSITY * height + higher;
        let body = json!({
            "shape": { "kind": "box", "min": [0.28, bottom], "max": [0.28 + width, bottom + height] },
            "rigid": { "density": density, "angular_velocity": [spin] }
        });
        let scene = sound(&tank([tank_width, 0.64], 0.32, spacing, 5.0, &[body]));
        let (_, all) = run(&scene, 35);
        let water = scene.particles.len() as f64 * spacing * spacing;
        let level = (water + width * height * density / DENSITY) / tank_width;
        let late = || all[25..].iter().map(|frame| frame.bodies[0]);
        let most = |of: fn(&BodyMotion) -> f64| late().map(|body| of(&body)).fold(0.0, f64::max);
        let mean = late().map(|body| body.center.y).sum::<f64>() / late().count() as f64;
        let draught = level - (mean - 0.5 * height);
        let off = (draught - density / DENSITY * height) / height;
        let tilt = most(|body| 2.0 * body.orientation.z.asin().abs().to_degrees());
        let speed = most(|body| body.velocity.length());
        let turning = most(|body| body.angular_velocity.length());
        let told = format!(
            "{density} kg/m³: its draught is off by {:.2} % of its height, it leans by {tilt:.2} degrees, moves by \
             {speed:.1e} m/s and turns by {turning:.1e} rad/s",
            100.0 * off
        );
        println!("{told}");
        if off.abs() > bar || tilt > 1.0 || speed > 0.03 || turning > 0.1 {
            far.push(told);
        }
        let last = all[35].convergence.expect("figures of the loops");
        assert_eq!((last.density_unconverged, last.divergence_unconverged), (0, 0));
    }
    assert!(far.is_empty(), "{far:?}");
}

/// Momentum and angular momentum of fluid and bodies.
fn of_all(scene: &Scene, frame: &Frame, fluid: &Particles) -> [DVec3; 2] {
    let mass = DENSITY * (2.0 * scene.radius()).powi(scene.dimensions.count() as i32);
    let mut sums = momenta(scene, &frame.bodies);
    for (x, v) in fluid.position.iter().zip(&fluid.velocity) {
        let p = mass * v.as_dvec3();
        sums[0] += p;
        sums[1] += (x.as_dvec3() + scene.origin).cross(p);
    }
    sums
}

/// A block of fluid without weight, one body in it, one that flies into it, and two that fly into each other beside it.
fn space(dimensions: usize, viscosity: f64) -> Value {
    let at = |numbers: [f64; 3]| json!(&numbers[..dimensions]);
    let spin = if dimensions == 2 {
        json!([4])
    } else {
        json!([1, -2, 4])
    };
    let spacing = if dimensions == 2 { 0.02 } else { 0.04 };
    json!({
        "dimensions": dimensions,
        "domain": { "min": at([-1.0; 3]), "max": at([1.0; 3]), "walls": "open" },
        "gravity": at([0.0; 3]),
        "fluid": { "spacing": spacing, "density": DENSITY, "viscosity": viscosity, "max_speed": 2 },
        "bodies": [
            { "shape": { "kind": "box", "min": at([-0.28, -0.2, -0.2]), "max": at([0.28, 0.2, 0.2]) } },
            { "shape": { "kind": "sphere", "center": at([0.1, 0.02, 0.01]), "radius": 0.1 }, "rigid": { "density": 2000 } },
            {
                "shape": { "kind": "box", "min": at([-0.6, -0.06, -0.1]), "max": at([-0.4, 0.14, 0.06]) },
                "velocity": at([1.5, 0.1, 0.0]), "rigid": { "density": 300, "angular_velocity": spin }
            },
            {
                "shape": { "kind": "box", "min": at([-0.2, 0.6, -0.1]), "max": at([0.0, 0.8, 0.1]) },
                "velocity": at([1.0, 0.0, 0.0]), "rigid": { "density": 500 }
            },
            {
                "shape": { "kind": "sphere", "center": at([0.2, 0.63, 0.02]), "radius": 0.1 },
                "velocity": at([-0.5, 0.1, 0.0]), "rigid": {}
            },
        ],
        "time": { "duration": 0.4, "fps": 20 },
    })
}

#[test]
fn what_bodies_get_fluid_loses() {
    for (dimensions, viscosity) in [(2, 0.0), (2, 5.0), (3, 0.5)] {
        let scene = sound(&space(dimensions, viscosity));
        let (simulation, all) = run(&scene, 6);
        let before = of_all(&scene, &all[0], &scene.particles);
        let after = of_all(&scene, &all[6], &simulation.particles().expect("particles"));
        let bodies = scene.rigid_bodies.iter();
        let scale: f64 = bodies.map(|body| body.mass * body.velocity.length()).sum();
        let linear = before[0].distance(after[0]) / scale;
        // Of a momentum that passes at the length of the block.
        let angular = before[1].distance(after[1]) / (0.56 * scale);
        let got = all[0].bodies.iter().zip(&all[6].bodies);
        let got: Vec<f64> = got.map(|(a, b)| a.velocity.distance(b.velocity)).collect();
        println!(
            "{dimensions}D, {viscosity} Pa s: linear {linear:.1e}, angular {angular:.1e}; {got:.2?} m/s"
        );
        assert!(
            got.iter().all(|&changed| changed > 0.01),
            "all bodies were hit: {got:?}"
        );
        assert!(linear < 1e-6, "{dimensions}D: momentum is off by {linear:.1e}");
        assert!(
            angular < 1e-3,
            "{dimensions}D: angular momentum is off by {angular:.1e}"
        );
    }
}

/// Boxes that a wave throws about.
fn splash() -> Value {
    let boxes = json!({
        "shape": { "kind": "box", "min": [0.5, 0.0], "max": [0.6, 0.08] },
        "rigid": { "density": 400, "copies": { "counts": [2, 2], "step": [0.16, 0.14], "random_rotation": false } }
    });
    let mut file = tank([0.9, 0.6], 0.4, 0.02, 0.1, &[boxes]);
    file["bodies"][0]["shape"]["max"][0] = json!(0.3);
    file
}

#[test]
fn a_run_that_goes_on_has_the_same_bytes() {
    let scene = sound(&splash());
    let (middle, last) = (4, 7);
    let end = |simulation: &mut Simulation| -> State {
        common::frames(simulation, last);
        simulation.save_state().expect("a state")
    };
    let (mut first, _) = run(&scene, middle);
    let state = first.save_state().expect("a state");
    let mut second = common::simulate(&scene, &wanted());
    second.restore(&state).expect("restored");
    assert!(
        second.save_state().expect("a state") == state,
        "restoring changes the state"
    );
    let whole = end(&mut first);
    assert!(end(&mut second) == whole, "the end differs");
    let (again, _) = run(&scene, last);
    assert!(again.save_state().expect("a state") == whole, "runs differ");
    let mut other = splash();
    other["bodies"][1]["rigid"]["copies"]["counts"][0] = json!(1);
    let refused = common::simulate(&sound(&other), &wanted()).restore(&state);
    let refused = refused.unwrap_err().to_string();
    assert!(refused.contains("does not fit the scene"), "{refused}");
}

#[test]
fn heavy_bodies_come_to_rest_on_the_floor_and_on_each_other() {
    let stone = |low: f64| {
        json!({
            "shape": { "kind": "box", "min": [0.2, low], "max": [0.4, low + 0.1] }, "rigid": { "density": 3000 }
        })
    };
    let mut file = tank([0.6, 0.5], 0.1, 0.02, 1.0, &[stone(0.02), stone(0.14)]);
    file["time"]["duration"] = json!(3);
    let scene = sound(&file);
    let (_, all) = run(&scene, 30);
    // Springs are as soft as steps are long.
    for (number, (body, most)) in all[30].bodies.iter().zip([0.2, 0.5]).enumerate() {
        let above = body.center.y - 0.05 - 0.1 * number as f64;
        println!("{number}: {above:.4} m, {:.1e} m/s", body.velocity.length());
        assert!(above.abs() < most * 0.02, "body {number}: {above} m");
        assert!(
            body.velocity.length() < 0.01,
            "body {number}: {} m/s",
            body.velocity
        );
    }
}

#[test]
fn what_floating_bodies_do_not_know_is_refused() {
    let body = json!({ "shape": { "kind": "box", "min": [0.2, 0.3], "max": [0.4, 0.4] }, "rigid": {} });
    let good = tank([0.6, 0.6], 0.3, 0.02, 0.1, &[body]);
    assert!(parse(&good).is_ok());
    for (path, value, expected) in [
        ("/fluid/solver", json!("wcsph"), "of the solver `dfsph` only"),
        ("/bodies/1/spacing", json!(0.02), "has no effect on a rigid body"),
        (
            "/bodies/1/pressure",
            json!("hydrostatic"),
            "has no effect on a rigid body",
        ),
        ("/bodies/1/jitter", json!(0.1), "stand in order"),
        ("/bodies/1/shape/min", json!([0.39, 0.39]), "too small"),
        (
            "/bodies/1/shape/max",
            json!([0.7, 0.4]),
            "reaches through the domain's side",
        ),
        (
            "/bodies/1/shape",
            json!({ "kind": "ring", "center": [0.3, 0.4], "inner": 0.05, "outer": 0.1 }),
            "needs a surface that is known",
        ),
        ("/bodies/1/rigid/color", json!("wood"), "is not a color"),
        (
            "/render",
            json!({ "passes": ["depth"] }),
            "are in no extra images",
        ),
        ("/render", json!({ "shutter": 0.5 }), "have no motion blur"),
        (
            "/bodies/1/rigid/copies",
            json!({ "counts": [2, 1], "step": [0.1, 0] }),
            "to others",
        ),
        ("/time/adaptive", json!(true), "how fast rigid bodies turn"),
        ("/domain/walls", json!("periodic"), "periodic"),
    ] {
        let mut file = good.clone();
        match file.pointer_mut(path) {
            Some(place) => *place = value.clone(),
            None => {
                let (parent, key) = path.rsplit_once('/').expect("a path");
                file.pointer_mut(parent).expect("its parent")[key] = value.clone();
            }
        }
        match parse(&file) {
            Ok(_) => panic!("{path} = {value} is accepted"),
            Err(error) => assert!(error.to_string().contains(expected), "{path}: {error}"),
        }
    }
}

#[test]
fn a_scene_without_bodies_pays_nothing() {
    let names = |bodies: &[Value]| -> (Vec<String>, u32) {
        let scene = sound(&tank([0.6, 0.6], 0.3, 0.02, 0.1, bodies));
        let plan = Plan::new(&scene, &Limits::PROMISED, &wanted()).expect("a plan");
        let passes = plan.passes.iter().map(|row| row.pass.shader.clone());
        let buffers = plan.buffers.iter().map(|buffer| buffer.name.clone());
        let is_own = |name: &String| ["bod", "member"].iter().any(|own| name.contains(own));
        (
            passes.chain(buffers).filter(is_own).collect(),
            plan.most_storage_buffers().1,
        )
    };
    assert_eq!(names(&[]).0, Vec::<String>::new());
    let body = json!({ "shape": { "kind": "sphere", "center": [0.3, 0.4], "radius": 0.08 }, "rigid": {} });
    let (own, bound) = names(&[body]);
    assert!(own.len() >= 8, "{own:?}");
    assert!(bound <= 8, "a pass binds {bound} storage buffers");
}
