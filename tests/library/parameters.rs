//! What events change of a fluid while it runs: each parameter has its effect from then on, and none before.

use sliceflow::gpu::Limits;
use sliceflow::output::columns_named;
use sliceflow::plan::{Plan, Wanted};
use sliceflow::scene::Scene;

use crate::common::{self, frames};

/// A parameter, the value that an event gives it, what the scene needs besides, and the flag or the formula that the shaders need.
type Case = (
    &'static str,
    &'static str,
    &'static [&'static str],
    Option<&'static str>,
);

const CASES: &[Case] = &[
    ("viscosity", "20", &[], Some("central_viscosity")),
    (
        "viscosity",
        "20",
        &["fluid.viscosity_form=stress"],
        Some("stress_viscosity"),
    ),
    ("viscosity", "20", &["fluid.solver=sph"], Some("muller_viscosity")),
    ("viscosity", "20", &["fluid.solver=dfsph"], Some("drag")),
    ("artificial_viscosity", "2", &[], Some("artificial_viscosity")),
    (
        "artificial_viscosity",
        "2",
        &["fluid.solver=dfsph"],
        Some("artificial_viscosity"),
    ),
    (
        "surface_tension",
        "20",
        &["fluid.negative_pressure=keep"],
        Some("surface_tension"),
    ),
    ("sound_speed", "20", &[], None),
    (
        "wall_friction",
        "1",
        &["fluid.slip=free_slip"],
        Some("wall_friction"),
    ),
];

/// A dam that breaks, in which an event changes a parameter behind the first of two frames.
fn scene((key, value, needs, _): &Case, changes: bool) -> Scene {
    let event = format!("events=[{{\"at\":0.05,\"set\":{{\"{key}\":{value}}}}}]");
    // Steps of both are equally long.
    let step = "time.step=0.0002";
    let mut overrides = vec!["colliders=[]", step];
    overrides.extend(*needs);
    if changes {
        overrides.push(&event);
    }
    common::fluid(2, &overrides)
}

fn wanted() -> Wanted {
    Wanted {
        columns: columns_named(["position", "velocity"]).expect("columns"),
        ..Wanted::default()
    }
}

#[test]
fn a_change_acts_from_its_time_on() {
    for case in CASES {
        let (key, _, needs, flag) = case;
        let [before, changed] = [false, true].map(|changes| {
            let scene = scene(case, changes);
            let mut simulation = common::simulate(&scene, &wanted());
            frames(&mut simulation, 2)
        });
        let what = format!("{key} {needs:?}");
        assert!(before[0].columns == changed[0].columns, "{what}: frame 0 differs");
        assert!(
            before[2].columns != changed[2].columns,
            "{what}: frame 2 is the same"
        );
        if let Some(flag) = flag {
            let composed = |changes| {
                let plan = Plan::new(&scene(case, changes), &Limits::PROMISED, &wanted()).expect("a plan");
                let formulas = plan.variant.lists.values().flatten();
                plan.variant.flags.contains(*flag)
                    || formulas
                        .filter_map(|file| file.rsplit('/').next())
                        .any(|formula| formula == *flag)
            };
            assert_eq!([composed(false), composed(true)], [false, true], "{what}");
        }
    }
}

#[test]
fn what_is_on_but_zero_changes_nothing_before() {
    // Terms that are added as zeros leave the first frame as it is, but for rounding.
    for case in CASES {
        let [before, changed] = [false, true].map(|changes| {
            let mut simulation = common::simulate(&scene(case, changes), &wanted());
            let all = frames(&mut simulation, 1);
            let particles = simulation.particles().expect("particles");
            (all.len(), particles.velocity)
        });
        assert_eq!(before.0, changed.0);
        let farthest = before.1.iter().zip(&changed.1).map(|(a, b)| a.distance(*b));
        let farthest = farthest.fold(0.0, f32::max);
        assert!(farthest < 1e-5, "{}: {farthest} m/s", case.0);
    }
}

#[test]
fn a_run_goes_on_with_what_was_changed() {
    let case = &("viscosity", "20", &[][..], None);
    let scene = scene(case, true);
    let mut through = common::simulate(&scene, &wanted());
    frames(&mut through, 1);
    let mut resumed = common::simulate(&scene, &wanted());
    resumed
        .restore(&through.save_state().expect("a state"))
        .expect("restored");
    let [whole, half] = [&mut through, &mut resumed].map(|simulation| frames(simulation, 2));
    assert!(whole.last().unwrap().columns == half.last().unwrap().columns);
}

#[test]
fn steps_are_as_short_as_every_value_demands() {
    let limited = |events: &str| {
        let scene = common::fluid(2, &["colliders=[]", events]);
        (scene.time.step, scene.time.limited_by)
    };
    let (usual, by) = limited("events=[]");
    assert_eq!(by, "speed of sound");
    let (viscous, by) = limited("events=[{\"at\":0.01,\"set\":{\"viscosity\":1000}}]");
    assert!(viscous < usual && by == "viscosity", "{viscous} s by {by}");
    let (fast, by) = limited("events=[{\"at\":0.01,\"set\":{\"sound_speed\":100}}]");
    assert!(fast < 0.2 * usual && by == "speed of sound", "{fast} s by {by}");
    // What comes later and takes it back does not.
    let (both, _) = limited(
        "events=[{\"at\":0.01,\"set\":{\"sound_speed\":100}},{\"at\":0.02,\"set\":{\"sound_speed\":10}}]",
    );
    assert_eq!(both, fast);
}

#[test]
fn of_several_fluids_one_can_change() {
    let scene = |set: &str| {
        let event = format!("events=[{{\"at\":0.01,\"set\":{set}}}]");
        let materials =
            "fluid.materials=[{\"name\":\"water\",\"density\":1000},{\"name\":\"oil\",\"density\":900}]";
        common::fluid(2, &["colliders=[]", materials, &event])
    };
    let viscosities = |set: &str| -> Vec<f64> {
        let scene = scene(set);
        let last = scene
            .matters()
            .last()
            .expect("a fluid")
            .fluid()
            .expect("a fluid")
            .clone();
        last.materials.iter().map(|material| material.viscosity).collect()
    };
    assert_eq!(viscosities("{\"viscosity\":2}"), [2.0, 2.0]);
    assert_eq!(viscosities("{\"viscosity\":2,\"material\":\"oil\"}"), [0.0, 2.0]);
}
