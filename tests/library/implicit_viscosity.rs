//! Viscosity of `dfsph` that is too high for explicit steps: a loop finds what it does, whatever the length of a step.

use std::f64::consts::TAU;
use std::path::Path;

use glam::{DVec3, Vec3};
use sliceflow::plan::{Plan, Wanted};
use sliceflow::scene::{Scene, load};
use sliceflow::simulation::Frame;

use crate::common::{self, convergence, measured_frames as frames};

fn parse(text: &str) -> Scene {
    match load::parse(text, "test.json", Path::new("."), &[]) {
        Ok(scene) => scene,
        Err(error) => panic!("{error}"),
    }
}

fn is_implicit(scene: &Scene) -> bool {
    scene.fluid().expect("a fluid").implicit_viscosity
}

/// A square of side 1 m in which space repeats, of fluid of so many particles a side; a frame is a step of 1/80 s.
fn square(particles: usize, viscosity: f64) -> Scene {
    parse(&format!(
        r#"{{
        "dimensions": 2,
        "domain": {{ "min": [0, 0], "max": [1, 1], "walls": "periodic" }},
        "gravity": [0, 0],
        "fluid": {{ "spacing": {}, "viscosity": {viscosity}, "max_speed": 1 }},
        "bodies": [{{ "shape": {{ "kind": "box", "min": [0, 0], "max": [1, 1] }} }}],
        "time": {{ "duration": 0.5, "fps": 80, "step": 0.0125 }}
    }}"#,
        1.0 / particles as f64
    ))
}

/// A wave of shear decays by 1/(1 + ν k² Δt) in a step of Euler's implicit method, along the lattice and across it. A lattice
/// that has not been sheared yet resists by 6.5 % more than the sheared ones that forces are right for on average.
#[test]
fn waves_of_shear_decay_as_theory_says() {
    for (waves, along) in [
        (DVec3::new(0.0, 1.0, 0.0), DVec3::X),
        (DVec3::new(1.0, 1.0, 0.0), DVec3::new(1.0, -1.0, 0.0).normalize()),
    ] {
        for (viscosity, last) in [(50.0, 10), (1000.0, 4)] {
            let mut scene = square(32, viscosity);
            assert!(is_implicit(&scene));
            let places: Vec<DVec3> = scene.particles.position.iter().map(|p| p.as_dvec3()).collect();
            let wave = |p: &DVec3| (TAU * waves.dot(*p)).sin();
            // So slow that the lattice stays one.
            for (v, p) in scene.particles.velocity.iter_mut().zip(&places) {
                *v = (0.01 * wave(p) * along).as_vec3();
            }
            let (simulation, frames) = frames(&scene, last);
            let particles = simulation.particles().expect("particles");
            let amplitude = |v: &Vec3, p: &Vec3| 2.0 * v.as_dvec3().dot(along) * wave(&p.as_dvec3());
            let each = particles.velocity.iter().zip(&particles.position);
            let count = particles.velocity.len() as f64;
            let found = each.map(|(v, p)| amplitude(v, p)).sum::<f64>() / count / 0.01;
            let rate = viscosity / 1000.0 * TAU * TAU * waves.length_squared();
            let steps: u32 = frames.iter().map(|frame| convergence(frame).steps).sum();
            assert_eq!(steps, last);
            let expected = (1.0 + rate / 80.0).powi(-(last as i32));
            let share = found.ln() / expected.ln();
            assert!(
                (1.0..1.09).contains(&share),
                "{viscosity} Pa·s, waves {waves}: {found} of {expected} is left"
            );
        }
    }
}

/// Fluid between walls, which stick to it, is driven along by its weight: v = g y (H − y) / 2ν.
#[test]
fn flow_between_plates_has_the_speed_of_theory() {
    let (height, viscosity, gravity) = (0.5, 500.0, 1.0);
    let scene = parse(
        r#"{
        "dimensions": 2,
        "domain": { "min": [0, 0], "max": [0.25, 0.5],
                    "sides": { "x_min": "periodic", "x_max": "periodic" } },
        "gravity": [1, 0],
        "fluid": { "spacing": 0.025, "viscosity": 500, "max_speed": 0.5 },
        "bodies": [{ "shape": { "kind": "box", "min": [0, 0], "max": [0.25, 0.5] } }],
        "time": { "duration": 1, "fps": 10 }
    }"#,
    );
    assert!(is_implicit(&scene));
    let (simulation, frames) = frames(&scene, 10);
    let particles = simulation.particles().expect("particles");
    let expected = gravity * height * height / 12.0 / (viscosity / 1000.0);
    let mean =
        particles.velocity.iter().map(|v| f64::from(v.x)).sum::<f64>() / particles.velocity.len() as f64;
    assert!(
        (mean / expected - 1.0).abs() < 0.04,
        "mean {mean} m/s of {expected} m/s"
    );
    let loops = convergence(&frames[10]);
    assert_eq!(loops.viscosity_unconverged, 0);
}

#[test]
fn a_turning_disc_keeps_its_momentum_and_its_turn() {
    for dimensions in [2, 3] {
        let size = ["[-1,-1]", "[-1,-1,-1]"][dimensions - 2];
        let far = ["[1,1]", "[1,1,1]"][dimensions - 2];
        let center = ["[0,0]", "[0,0,0]"][dimensions - 2];
        let mut scene = parse(&format!(
            r#"{{
            "dimensions": {dimensions},
            "domain": {{ "min": {size}, "max": {far}, "walls": "open" }},
            "gravity": {center},
            "fluid": {{ "spacing": 0.05, "viscosity": 1000, "max_speed": 1 }},
            "bodies": [{{ "shape": {{ "kind": "sphere", "center": {center}, "radius": 0.3 }} }}],
            "time": {{ "duration": 0.2, "fps": 10 }}
        }}"#
        ));
        assert!(is_implicit(&scene));
        let origin = scene.origin;
        let drift = Vec3::new(0.2, -0.1, 0.0);
        for (k, (v, p)) in scene
            .particles
            .velocity
            .iter_mut()
            .zip(&scene.particles.position)
            .enumerate()
        {
            let place = (p.as_dvec3() + origin).as_vec3();
            let noise = 0.1 * Vec3::new((1.7 * k as f32).sin(), (2.3 * k as f32).cos(), 0.0);
            *v = drift + 0.5 * Vec3::new(-place.y, place.x, 0.0) + noise;
        }
        let sums = |position: &[Vec3], velocity: &[Vec3]| {
            let each = position.iter().zip(velocity);
            let each = each.map(|(p, v)| (p.as_dvec3() + origin, v.as_dvec3()));
            let (mut momentum, mut turn) = (DVec3::ZERO, DVec3::ZERO);
            for (p, v) in each {
                momentum += v;
                turn += p.cross(v);
            }
            let count = position.len() as f64;
            (momentum / count, turn / count)
        };
        let (momentum, turn) = sums(&scene.particles.position, &scene.particles.velocity);
        let (simulation, frames) = frames(&scene, 2);
        let particles = simulation.particles().expect("particles");
        let (momentum_then, turn_then) = sums(&particles.position, &particles.velocity);
        let lost = (momentum_then - momentum).length();
        assert!(
            lost < 1e-5,
            "{dimensions}D: momentum is off by {lost} m/s per particle"
        );
        let turned = (turn_then - turn).length() / turn.length();
        assert!(
            turned < 0.01,
            "{dimensions}D: angular momentum is off by {turned} of itself"
        );
        // The noise is gone, and what turns as a whole is not.
        let energy = |frame: &Frame| frame.statistics.expect("statistics").kinetic_energy;
        assert!(energy(&frames[2]) < 0.95 * energy(&frames[0]));
    }
}

/// Chebyshev's iteration needs about √(Δt ν / Δx²) sweeps.
#[test]
fn its_loop_takes_few_iterations_and_tells_when_they_do_not_suffice() {
    let run = |viscosity: f64, most: u32| {
        let scene = parse(&format!(
            r#"{{
            "domain": {{ "min": [0, 0, 0], "max": [0.4, 0.4, 0.4] }},
            "fluid": {{ "spacing": 0.04, "viscosity": {viscosity}, "max_iterations": {most} }},
            "bodies": [{{ "shape": {{ "kind": "box", "min": [0.1, 0.1, 0.1], "max": [0.3, 0.35, 0.3] }} }}],
            "time": {{ "duration": 0.1, "fps": 20 }}
        }}"#
        ));
        assert!(is_implicit(&scene));
        let (_, frames) = frames(&scene, 2);
        convergence(&frames[2])
    };
    let honey = run(1000.0, 50);
    assert!(honey.steps > 0 && honey.viscosity_unconverged == 0);
    assert!(
        honey.most_viscosity_iterations <= 12,
        "{} iterations",
        honey.most_viscosity_iterations
    );
    assert!(honey.viscosity_error <= 0.01, "{}", honey.viscosity_error);
    let pitch = run(1e6, 3);
    assert!(pitch.viscosity_unconverged > 0 && pitch.most_viscosity_iterations == 3);
    assert!(pitch.viscosity_error > 0.01 && pitch.viscosity_error.is_finite());
}

/// Explicit steps where these are long enough anyway, and the plan says what it chose.
#[test]
fn only_viscosity_that_would_shorten_steps_is_implicit() {
    let scene = |viscosity: &str| common::fluid(2, &["fluid.solver=dfsph", viscosity]);
    let [water, honey] = ["fluid.viscosity=1", "fluid.viscosity=1000"].map(scene);
    assert!(!is_implicit(&water) && is_implicit(&honey));
    assert_eq!(water.time.step, honey.time.step);
    assert!(!is_implicit(&common::fluid(2, &["fluid.viscosity=1000"])));
    // A short step of the scene's own is short enough for explicit viscosity.
    assert!(!is_implicit(&common::fluid(
        2,
        &["fluid.solver=dfsph", "fluid.viscosity=1000", "time.step=1e-5"]
    )));
    // What events set counts from the start.
    let thickens = common::fluid(
        2,
        &[
            "fluid.solver=dfsph",
            "events=[{\"at\":0.05,\"set\":{\"viscosity\":1000}}]",
        ],
    );
    assert!(is_implicit(&thickens));

    let plan = |scene: &Scene| {
        let wanted = Wanted::default();
        Plan::new(scene, &sliceflow::gpu::device::Limits::PROMISED, &wanted).expect("a plan")
    };
    let (without, with) = (plan(&water), plan(&honey));
    let tells = |plan: &Plan| plan.notes.iter().any(|note| note.contains("implicitly"));
    assert!(!tells(&without) && tells(&with), "{:?}", with.notes);
    let sweeps = |plan: &Plan| {
        plan.passes
            .iter()
            .filter(|row| row.pass.entry.starts_with("damp"))
            .count()
    };
    assert_eq!((sweeps(&without), sweeps(&with)), (0, 2));
}
