//! Steps whose length the device chooses: they land exactly, follow what happens, and give the same bits every time.

use glam::Vec3;
use sliceflow::error::Error;
use sliceflow::output::columns_named;
use sliceflow::physics::collider::offset_at;
use sliceflow::plan::Wanted;
use sliceflow::scene::{Particles, Scene};
use sliceflow::simulation::{ColumnData, Frame, Values};

use crate::common;

const ADAPTIVE: &str = "time.adaptive=true";

fn wanted() -> Wanted {
    Wanted {
        statistics: true,
        columns: columns_named(["position", "velocity"]).expect("columns"),
        ..Default::default()
    }
}

fn run(scene: &Scene, timed: bool) -> sliceflow::error::Result<Vec<Frame>> {
    let mut simulation = common::simulate(scene, &wanted());
    simulation.set_timings(timed);
    let mut frames = Vec::new();
    for _ in 0..scene.time.frames {
        frames.extend(simulation.next_frame()?);
    }
    while let Some(frame) = simulation.finish_frame()? {
        frames.push(frame);
    }
    Ok(frames)
}

fn frames(scene: &Scene) -> Vec<Frame> {
    run(scene, false).unwrap_or_else(|error| panic!("{error}"))
}

/// All numbers of a column, as f64.
fn column(frame: &Frame, name: &str) -> Vec<f64> {
    let find = |column: &&ColumnData| column.name == name;
    match &frame.columns.iter().find(find).expect("the column").values {
        Values::Vector { values, .. } => values.iter().map(|&v| v.into()).collect(),
        Values::Double { values, .. } => values.clone(),
        _ => panic!("{name} is a vector"),
    }
}

/// One particle of fluid or one grain that nothing holds.
fn falling(fluid: bool, overrides: &[&str]) -> Scene {
    let one = r#"bodies=[{"shape":{"kind":"box","min":[0,0.2],"max":[0.050001,0.250001]}}]"#;
    let all = [
        &[
            "domain.walls=open",
            "domain.sides={}",
            "colliders=[]",
            one,
            ADAPTIVE,
        ],
        overrides,
    ]
    .concat();
    let mut scene = if fluid {
        common::fluid(2, &all)
    } else {
        common::scene(2, &all)
    };
    scene.particles.position.truncate(1);
    scene.particles.velocity = vec![Vec3::ZERO];
    scene.particles.density_deviation.truncate(1);
    scene
}

#[test]
fn frames_land_on_their_times() {
    for fluid in [true, false] {
        for integrator in ["symplectic_euler", "velocity_verlet"] {
            let scene = falling(
                fluid,
                &[
                    &format!("time.integrator={integrator}"),
                    "gravity=[0,-10]",
                    "time.fps=7.3",
                    "time.duration=0.6",
                ],
            );
            let frames = frames(&scene);
            assert_eq!(frames.len(), 5);
            let (mut shortest, mut longest) = (1.0f64, 0.0f64);
            for frame in &frames[1..] {
                let (t, steps) = (frame.time, frame.adaptive.as_ref().expect("adaptive steps"));
                let fallen =
                    f64::from(scene.particles.position[0].y) + scene.origin.y - column(frame, "position")[1];
                let speed = -column(frame, "velocity")[1];
                // Hundreds of steps, each rounded.
                assert!(
                    (speed / (10.0 * t) - 1.0).abs() < 1e-5,
                    "{integrator}: {speed} at {t}"
                );
                shortest = shortest.min(steps.shortest_s);
                longest = longest.max(steps.longest_s);
                // Symplectic Euler falls by g Σ Δt²/2 more.
                let most = 5.0 * t * (t + longest);
                let least = match integrator {
                    "velocity_verlet" => 5.0 * t * t,
                    _ => 5.0 * t * (t + shortest),
                };
                let most = if integrator == "velocity_verlet" {
                    least
                } else {
                    most
                };
                assert!(
                    fallen > least * (1.0 - 2e-5) && fallen < most * (1.0 + 2e-5),
                    "{integrator}: {fallen} at {t}, not within {least} and {most}"
                );
                assert!(steps.shortest_s <= frame.step_s && frame.step_s <= steps.longest_s * 1.0001);
            }
        }
    }
}

/// A fixed step would change gravity up to a step later.
#[test]
fn events_happen_at_their_times() {
    let scene = falling(
        false,
        &[
            r#"events=[{"at":0.0377,"set":{"gravity":[0,20]}}]"#,
            "gravity=[0,-10]",
            "time.fps=10",
            "time.duration=0.1",
        ],
    );
    let last = frames(&scene).pop().expect("a frame");
    let speed = column(&last, "velocity")[1];
    let expected = -10.0 * 0.0377 + 20.0 * (0.1 - 0.0377);
    assert!(
        (speed - expected).abs() < 1e-5 * expected,
        "{speed}, not {expected}"
    );
}

#[test]
fn obstacles_keep_to_their_paths() {
    let path = r#"colliders=[{"name":"post","shape":{"kind":"sphere","center":[0.75,0.25],"radius":0.1},
        "path":[{"at":0,"offset":[0,0]},{"at":0.031,"offset":[0.02,0]},{"at":0.1,"offset":[0,0.05]}]}]"#;
    let scene = common::fluid(2, &[ADAPTIVE, path]);
    let mut simulation = common::simulate(&scene, &Wanted::default());
    for index in 0..scene.time.frames {
        simulation.next_frame().expect("a frame");
        let state = simulation.save_state().expect("a state");
        let offset = offset_at(&scene.colliders[0].path, f64::from(index) / scene.time.fps);
        let first = scene.first_boundary() as usize;
        let mut seen = 0;
        for (id, position) in state.ids().iter().zip(state.vectors("position").unwrap()) {
            if let Some(wall) = (*id as usize).checked_sub(first)
                && scene.boundary.body[wall] == 0
            {
                let expected = scene.boundary.position[wall] + offset;
                assert!(
                    position.distance(expected) < 2e-6,
                    "frame {index}: {position} {expected}"
                );
                seen += 1;
            }
        }
        assert!(seen > 5);
    }
}

/// A plate rises under a grain and takes it along as with fixed steps.
#[test]
fn obstacles_push_grains_as_with_fixed_steps() {
    let plate = r#"colliders=[{"name":"plate","shape":{"kind":"box","min":[-0.3,-0.1],"max":[0.3,0]},
        "path":[{"at":0,"offset":[0,0]},{"at":0.2,"offset":[0,0.3]},{"at":0.3,"offset":[0,0.3]}]}]"#;
    let height = |adaptive: &str| {
        let scene = falling(
            false,
            &[
                plate,
                "gravity=[0,0]",
                "time.duration=0.3",
                "time.fps=10",
                adaptive,
            ],
        );
        let ways = frames(&scene)
            .iter()
            .map(|frame| column(frame, "position")[1])
            .collect::<Vec<_>>();
        ways[ways.len() - 1] - ways[0]
    };
    let (fixed, adaptive) = (height("time.adaptive=false"), height(ADAPTIVE));
    assert!(fixed > 0.1, "the plate pushes: {fixed}");
    assert!(
        (adaptive / fixed - 1.0).abs() < 0.02,
        "{adaptive} m instead of {fixed} m"
    );
}

/// What limited most steps of the second frame interval, and the mean step over the length that was expected.
fn limited(scene: &Scene) -> (&'static str, f64) {
    let frames = frames(scene);
    (frames[2].step_limited_by, frames[2].step_s / scene.time.step)
}

#[test]
fn the_limiting_term_is_named_and_steps_follow_it() {
    let moving = |scene: &mut Scene, speed: f32| scene.particles.velocity[0] = Vec3::X * speed;
    let drop = |overrides: &[&str], speed: f32| {
        let mut scene = falling(true, &[overrides, &["time.fps=20", "time.duration=0.1"]].concat());
        moving(&mut scene, speed);
        limited(&scene)
    };
    // Sound at 10 m/s, 1 m/s expected: 11 against 10.
    let (name, ratio) = drop(&[], 0.0);
    assert_eq!(name, "speed of sound");
    assert!(ratio > 1.0 && ratio < 1.12, "{ratio}");
    // 11 against 10 + 45.
    let (name, ratio) = drop(&[], 45.0);
    assert_eq!(name, "motion");
    assert!((ratio * 5.0 - 1.0).abs() < 0.1, "{ratio}");
    assert_eq!(drop(&["fluid.viscosity=3000"], 0.0).0, "viscosity");
    // Thrown upwards so that it turns in the first interval, and never gets fast.
    let mut thrown = falling(
        true,
        &["gravity=[0,-3e5]", "time.fps=1615", "time.duration=0.001"],
    );
    thrown.particles.velocity[0] = Vec3::Y * 100.0;
    assert_eq!(frames(&thrown)[1].step_limited_by, "acceleration");
    let (name, ratio) = drop(&["time.step=1e-4"], 0.0);
    assert_eq!(name, "scene's step");
    assert!((ratio - 1.0).abs() < 0.02, "{ratio}");

    let grain = |speed: f32| {
        let mut scene = falling(false, &["time.fps=20", "time.duration=0.1"]);
        moving(&mut scene, speed);
        limited(&scene)
    };
    assert_eq!(grain(0.0).0, "contact duration");
    assert_eq!(grain(100.0).0, "motion");
    // Frames shorter than a step.
    let frame = falling(true, &["time.fps=2000", "time.duration=0.001"]);
    assert_eq!(limited(&frame).0, "frame end");
    // Fixed steps tell theirs.
    let fixed = falling(true, &["time.adaptive=false", "time.fps=20", "time.duration=0.1"]);
    assert_eq!(limited(&fixed), ("speed of sound", 1.0));
}

/// A pressed block: sound is faster in it.
#[test]
fn stiffness_shortens_steps() {
    let body = r#"bodies=[{"shape":{"kind":"box","min":[0,0],"max":[0.3,0.3]}}]"#;
    let periodic = [
        "domain.walls=periodic",
        "domain.max=[0.3,0.3]",
        "colliders=[]",
        "gravity=[0,0]",
        "time.fps=100",
        "time.duration=0.04",
        body,
        ADAPTIVE,
    ];
    let mut scene = common::fluid(2, &periodic);
    scene.particles.density_deviation.fill(0.3);
    let (name, ratio) = limited(&scene);
    // 10 m/s × 1.3³ against 11 m/s.
    assert_eq!(name, "stiffness");
    assert!((ratio - 11.0 / (10.0 * 1.3f64.powi(3))).abs() < 0.03, "{ratio}");
}

/// Bits of everything that frames tell.
fn same(one: &[Frame], two: &[Frame]) -> bool {
    one.iter().zip(two).all(|(one, two)| {
        one.steps == two.steps
            && one.statistics == two.statistics
            && one.adaptive == two.adaptive
            && one.columns == two.columns
    }) && one.len() == two.len()
}

#[test]
fn every_run_has_the_same_bits() {
    let thrown = r#"bodies=[{"shape":{"kind":"box","min":[0,0.05],"max":[0.4,0.4]},"velocity":[3,-5]}]"#;
    let overrides = [ADAPTIVE, thrown];
    for scene in [
        common::fluid(2, &overrides),
        common::fluid(3, &[ADAPTIVE]),
        common::fluid(2, &[ADAPTIVE, thrown, "time.integrator=velocity_verlet"]),
        common::scene(2, &[ADAPTIVE, "time.duration=0.2"]),
    ] {
        let once = frames(&scene);
        assert!(once.last().is_some_and(|frame| frame.steps > 10));
        assert!(same(&once, &frames(&scene)));
        // Timing them makes rounds of other lengths.
        assert!(same(&once, &run(&scene, true).expect("frames")));
    }
}

/// A grid that grows has steps done again.
#[test]
fn growing_changes_no_bit() {
    let (position, velocity) = common::burst(3, 150);
    let scene = |margin: &str| {
        let choices = [ADAPTIVE, "time.fps=60", "time.duration=0.05", margin];
        common::open_scene(3, &choices, position.clone(), velocity.clone())
    };
    let tight = frames(&scene("neighbors.margin=1"));
    assert!(tight.iter().map(|frame| frame.reallocations).sum::<u32>() > 0);
    assert!(same(&tight, &frames(&scene("neighbors.margin=4"))));
}

/// Two blocks of fluid meet at ten and at twenty times the speed that their sound is made for.
#[test]
fn fast_impacts_gain_no_energy() {
    let block = |low: f64, high: f64, speed: f64| {
        format!(
            r#"{{"shape":{{"kind":"box","min":[{low},0.1],"max":[{high},0.40001]}},"velocity":[{speed},0]}}"#
        )
    };
    // The greatest energy over that at the start, and the shortest step over what was expected.
    let impact = |speed: f64, adaptive: &str| {
        let (left, right) = (block(0.05, 0.45001, speed), block(0.55, 0.95001, -speed));
        let blocks = format!("bodies=[{left},{right}]");
        let scene = common::fluid(
            2,
            &[
                &blocks,
                adaptive,
                "colliders=[]",
                "gravity=[0,0]",
                "domain.walls=open",
                "fluid.artificial_viscosity=0.05",
                "time.fps=200",
                "time.duration=0.05",
            ],
        );
        let frames = run(&scene, false)?;
        let energy = |frame: &Frame| frame.statistics.expect("statistics").kinetic_energy;
        let most = frames.iter().map(energy).fold(0.0, f64::max);
        let steps = frames.iter().filter_map(|frame| frame.adaptive.as_ref());
        let shortest = steps.map(|steps| steps.shortest_s).fold(f64::INFINITY, f64::min);
        Ok((most / energy(&frames[0]), shortest / scene.time.step))
    };
    for speed in [10.0, 20.0] {
        let (energy, step) = impact(speed, ADAPTIVE).unwrap_or_else(|error: Error| panic!("{error}"));
        assert!(energy < 1.0001, "{speed} m/s: {energy}");
        assert!(step < 11.0 / (10.0 + speed), "{speed} m/s: {step}");
        // What adaptive steps are for: fixed ones give energy, until a guard ends the run.
        match impact(speed, "time.adaptive=false") {
            Ok((energy, _)) => assert!(energy > 1.05, "{speed} m/s: {energy}"),
            Err(error) => assert!(matches!(error, Error::Guard(_)), "{error}"),
        }
    }
}

/// The same flow, by steps of either kind.
#[test]
fn a_dam_breaks_as_with_fixed_steps() {
    let center = |frame: &Frame| {
        let positions = column(frame, "position");
        let mean =
            |axis: usize| positions.iter().skip(axis).step_by(2).sum::<f64>() / (positions.len() / 2) as f64;
        [mean(0), mean(1)]
    };
    for choice in [
        "time.integrator=symplectic_euler",
        "time.integrator=velocity_verlet",
    ] {
        let dam = |adaptive: &str| {
            let overrides = [choice, adaptive, "colliders=[]", "time.duration=0.5"];
            frames(&common::fluid(2, &overrides))
        };
        let (fixed, adaptive) = (dam("time.adaptive=false"), dam(ADAPTIVE));
        let moved = center(&fixed[fixed.len() - 1])[0] - center(&fixed[0])[0];
        assert!(moved > 0.03, "{moved}");
        for (one, two) in fixed.iter().zip(&adaptive) {
            for axis in [0, 1] {
                let off = (center(one)[axis] - center(two)[axis]).abs();
                assert!(off < 0.02 * moved, "frame {}: {off}", one.index);
            }
        }
    }
}

#[test]
fn grains_bounce_as_they_should() {
    let mut scene = falling(
        false,
        &[
            "domain.walls=contact",
            "domain.sides={}",
            "gravity=[0,0]",
            "time.fps=100",
            "time.duration=0.3",
        ],
    );
    scene.particles.position[0] = Vec3::new(0.0, -0.25, 0.0);
    scene.particles.velocity[0] = Vec3::new(0.0, -1.0, 0.0);
    let last = frames(&scene).pop().expect("a frame");
    let speed = column(&last, "velocity")[1];
    assert!((speed - 0.6).abs() < 0.02, "{speed}");
}

#[test]
fn steps_that_would_never_end_a_run_stop_it() {
    let mut scene = falling(false, &["time.duration=0.1"]);
    scene.particles = Particles {
        velocity: vec![Vec3::X * 1e9],
        ..scene.particles
    };
    let error = run(&scene, false).expect_err("it would take 10^8 times as long");
    let message = error.to_string();
    assert!(
        message.contains("never end") && message.contains("limited by the motion"),
        "{message}"
    );
}

#[test]
fn adaptive_steps_need_lists() {
    for choice in ["neighbors.storage=pool", "neighbors.skin=0"] {
        let text = include_str!("../common/scene_2d.json");
        let overrides = [choice.to_owned(), ADAPTIVE.to_owned()];
        let error = sliceflow::scene::load::parse(text, "test.json", std::path::Path::new("."), &overrides);
        let message = error.expect_err("no lists").to_string();
        assert!(
            message.contains("time.adaptive: adaptive steps need neighbor lists"),
            "{message}"
        );
    }
}
