//! A run that goes on from a state is the run that was never interrupted, to the bit.

use sliceflow::output::columns_named;
use sliceflow::plan::Wanted;
use sliceflow::scene::Scene;
use sliceflow::simulation::{Frame, State};

use crate::common::{self, frames};

fn wanted() -> Wanted {
    Wanted {
        statistics: true,
        columns: columns_named(["position", "velocity", "contacts", "pressure"]).expect("columns"),
        ..Default::default()
    }
}

fn assert_same(one: &[Frame], two: &[Frame], what: &str) {
    assert_eq!(one.len(), two.len(), "{what}");
    for (one, two) in one.iter().zip(two) {
        let index = one.index;
        assert_eq!(
            (one.index, one.time, one.steps, one.particles, one.overflow),
            (two.index, two.time, two.steps, two.particles, two.overflow),
            "{what}"
        );
        assert_eq!(one.statistics, two.statistics, "{what}, frame {index}");
        for (a, b) in one.columns.iter().zip(&two.columns) {
            assert!(a == b, "{what}, frame {index}: {} differs", a.name);
        }
    }
}

/// Runs through and in two halves with the state between them; gives that state and the frames.
fn halves(scene: &Scene, what: &str) -> (State, Vec<Frame>) {
    let (middle, last) = (3, 6);
    let mut through = common::simulate(scene, &wanted());
    let whole = frames(&mut through, last);

    let mut first = common::simulate(scene, &wanted());
    assert_same(&frames(&mut first, middle), &whole[..=middle as usize], what);
    let state = first.save_state().expect("a state");
    let mut second = common::simulate(scene, &wanted());
    second.restore(&state).expect("restored");
    assert!(
        second.save_state().expect("a state") == state,
        "{what}: restoring changes the state"
    );
    let shown = second.show(middle).expect("shown");
    assert!(shown.is_none(), "the ring has room for it");
    let rest = frames(&mut second, last);
    assert_same(&rest, &whole[middle as usize..], what);
    (state, whole)
}

/// Two emitters' worth of grains, moving obstacles and changing gravity happen before and behind the middle.
#[test]
fn a_state_carries_everything_that_the_next_step_needs() {
    for dimensions in [2, 3] {
        for (grid, integrator) in [
            (
                ["neighbors.addressing=sliced", "neighbors.storage=counting"],
                "symplectic_euler",
            ),
            (
                ["neighbors.addressing=uniform", "neighbors.storage=pool"],
                "velocity_verlet",
            ),
            (
                ["neighbors.addressing=rows", "neighbors.storage=counting"],
                "velocity_verlet",
            ),
        ] {
            let integrator = format!("time.integrator={integrator}");
            let z = if dimensions == 2 { "" } else { ",0" };
            let events = format!(
                r#"events=[{{"at":0.12,"set":{{"gravity":[2,-9{z}],"spring":2500}}}},
                    {{"at":0.1,"drop":{{"center":[0.35,0.5{z}],"radius":0.09}}}},
                    {{"at":0.23,"drop":{{"center":[-0.4,0.6{z}],"radius":0.09}}}}]"#
            );
            let emitters = format!(
                r#"emitters=[{{"name":"tap","center":[0.35,0.2{z}],"velocity":[0,-1{z}],"radius":0.1}}]"#
            );
            let overrides = [
                grid[0],
                grid[1],
                &integrator,
                "neighbors.slots=2",
                &events,
                &emitters,
            ];
            let scene = common::scene(dimensions, &overrides);
            let (state, _) = halves(&scene, &format!("{dimensions}D, {overrides:?}"));
            assert_eq!(
                state.buffer("acceleration").is_some(),
                integrator.contains("verlet")
            );
        }
    }
}

/// Every way to address voxels, and every way to keep particles in them.
#[test]
fn every_search_goes_on() {
    for (addressing, storage) in [
        ("bitmap", "counting"),
        ("hash", "pool"),
        ("morton", "counting"),
        ("sliced", "radix"),
        ("uniform", "bitonic"),
    ] {
        let overrides = [
            &format!("neighbors.addressing={addressing}"),
            &format!("neighbors.storage={storage}"),
        ];
        let scene = common::scene(3, &overrides.map(String::as_str));
        halves(&scene, &format!("{addressing}-{storage}"));
    }
}

/// The next step's length is part of the state.
#[test]
fn adaptive_steps_go_on() {
    let events = r#"events=[{"at":0.12,"set":{"gravity":[2,-9]}},{"at":0.1,"drop":{"center":[0.35,0.5],"radius":0.09}}]"#;
    let adaptive = "time.adaptive=true";
    for integrator in [
        "time.integrator=symplectic_euler",
        "time.integrator=velocity_verlet",
    ] {
        halves(&common::scene(2, &[adaptive, events, integrator]), integrator);
        let thrown = r#"bodies=[{"shape":{"kind":"box","min":[0,0.05],"max":[0.4,0.4]},"velocity":[3,-5]}]"#;
        let scene = common::fluid(2, &[adaptive, thrown, integrator, "time.fps=60"]);
        let (state, _) = halves(&scene, &format!("fluid, {integrator}"));
        assert!(state.buffer("step_control").is_some());
    }
    halves(&common::fluid(2, &["fluid.solver=dfsph", "time.fps=60"]), "dfsph");
    let honey = ["fluid.solver=dfsph", "fluid.viscosity=1000", "time.fps=60"];
    halves(&common::fluid(2, &honey), "implicit viscosity");
}

/// Grains fly apart, so that the grid grows before and behind the middle.
#[test]
fn a_grid_that_grows_goes_on() {
    for addressing in ["sliced", "rows", "bitmap"] {
        let (position, velocity) = common::burst(3, 150);
        let grid = format!("neighbors.addressing={addressing}");
        let scene = common::open_scene(3, &[&grid], position, velocity);
        let (_, whole) = halves(&scene, &format!("{addressing}, growing"));
        let reallocations = |frames: &[Frame]| frames.iter().map(|frame| frame.reallocations).sum::<u32>();
        assert!(reallocations(&whole[..=3]) > 0, "{addressing}");
        assert!(reallocations(&whole[4..]) > 0, "{addressing}");
    }
}
