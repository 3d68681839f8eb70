//! A scene pays only for what it models. Plans need no GPU.

mod common;

use sliceflow::error::Error;
use sliceflow::gpu::device::Limits;
use sliceflow::neighbors::STORAGES;
use sliceflow::output::columns_named;
use sliceflow::plan::{Phase, Plan, Wanted};
use sliceflow::scene::Scene;
use sliceflow::scene::model::View;

fn plan(scene: &Scene, wanted: &Wanted) -> Plan {
    Plan::new(scene, &Limits::PROMISED, wanted).expect("a plan")
}

fn entries(plan: &Plan) -> Vec<&str> {
    plan.passes.iter().map(|row| row.pass.entry.as_str()).collect()
}

fn buffers(plan: &Plan) -> Vec<&str> {
    plan.buffers.iter().map(|buffer| buffer.name.as_str()).collect()
}

fn pictures() -> Wanted {
    Wanted {
        view: Some(View::Scene),
        ..Default::default()
    }
}

#[test]
fn two_dimensions_do_no_work_of_three() {
    let scene = common::scene(2, &[]);
    let flat = plan(&scene, &pictures());
    assert_eq!(flat.variant.constants["DIMENSIONS"], 2);
    assert!(flat.variant.flags.contains("two_dimensional"));
    assert_eq!(flat.grid.size[2], 1);
    // Two floats a vector, not four.
    let position = flat.buffers.iter().find(|b| b.name == "position").unwrap();
    assert_eq!(position.bytes, 8 * u64::from(scene.capacity));
    // Three rows of voxels around one, not nine: read from the shader that runs.
    let rows = |plan: &Plan| {
        let shader = sliceflow::gpu::compose::compose("physics/dem/symplectic_euler", &plan.variant).unwrap();
        let line = shader
            .text
            .lines()
            .find(|l| l.starts_with("const ROWS"))
            .unwrap()
            .to_owned();
        (
            line.contains("= ROW_VOXELS;"),
            line.contains("= ROW_VOXELS * ROW_VOXELS;"),
            shader.text.contains("vec3i"),
        )
    };
    assert_eq!(rows(&flat), (true, false, false));
    assert_eq!(
        rows(&plan(&common::scene(3, &[]), &pictures())),
        (false, true, true)
    );
}

#[test]
fn nobody_wants_anything_and_nothing_is_there_for_it() {
    let scene = common::scene(3, &["colliders=[]"]);
    let bare = plan(&scene, &Wanted::default());
    assert!(
        bare.passes.iter().all(|row| row.phase != Phase::Observe),
        "{:?}",
        entries(&bare)
    );
    assert!(bare.draws.is_empty() && bare.textures.is_empty());
    assert_eq!(bare.picture_bytes + bare.column_bytes, 0);
    let absent = [
        "sums",
        "partial_sums",
        "occupancy_count",
        "measure",
        "contacts",
        "density",
        "pressure",
        "frame_pixels",
        "colliders",
        "distance_field",
        "clamp_walls",
        "acceleration",
        "index_pool",
        "overflow",
    ];
    for name in absent {
        assert!(!buffers(&bare).contains(&name), "{name} is there for nobody");
    }

    let watched = plan(
        &scene,
        &Wanted {
            statistics: true,
            ..Default::default()
        },
    );
    for name in ["sums", "occupancy_count"] {
        assert!(buffers(&watched).contains(&name));
    }
    for entry in ["measure_grains", "total_sums", "measure_voxels"] {
        assert!(
            entries(&watched).contains(&entry) && !entries(&bare).contains(&entry),
            "{entry}"
        );
    }
}

#[test]
fn a_column_costs_a_buffer_only_where_it_is_wanted() {
    let scene = common::scene(3, &[]);
    let columns = columns_named(["position", "contacts"]).unwrap();
    let wanting = plan(
        &scene,
        &Wanted {
            columns,
            ..Default::default()
        },
    );
    assert!(buffers(&wanting).contains(&"contacts"));
    assert!(!buffers(&wanting).contains(&"pressure"));
    assert_eq!(wanting.column_bytes, u64::from(scene.capacity) * (3 * 8 + 4));
    // A picture colored by pressure needs it too.
    let scene = common::scene(3, &["render.color.by=pressure"]);
    assert!(buffers(&plan(&scene, &pictures())).contains(&"pressure"));
}

#[test]
fn terms_of_the_contact_law_are_compiled_only_where_a_scene_has_them() {
    let text = |overrides: &[&str]| {
        let plan = plan(&common::scene(3, overrides), &Wanted::default());
        sliceflow::gpu::compose::compose("physics/dem/symplectic_euler", &plan.variant)
            .unwrap()
            .text
    };
    let plain = text(&["colliders=[]"]);
    for term in [
        "contact.shear *",
        "contact.attraction *",
        "contact.global_damping *",
        "clamp_to_walls",
        "nearest_on",
    ] {
        assert!(!plain.contains(term), "{term}");
    }
    assert!(text(&["grains.shear=1"]).contains("contact.shear *"));
    // An event that sets it later counts too.
    assert!(text(&["events=[{\"at\":0.1,\"set\":{\"attraction\":1}}]"]).contains("contact.attraction *"));
    assert!(text(&["domain.walls=clamp"]).contains("clamp_to_walls"));
    assert!(!text(&["domain.walls=open"]).contains("with_walls"));
    let resting = text(&["colliders[0].path=[]"]);
    assert!(resting.contains("nearest_on_box") && !resting.contains("clock.step_in_segment)"));
}

#[test]
fn the_pool_view_works_with_every_storage_and_needs_no_scene_pictures() {
    for storage in STORAGES.iter().map(|row| row.name) {
        let scene = common::scene(3, &[&format!("neighbors.storage={storage}"), "render.view=pool"]);
        let plan = plan(
            &scene,
            &Wanted {
                view: Some(View::Pool),
                ..Default::default()
            },
        );
        assert!(
            !plan.textures.iter().any(|t| t.name == "shadow_map"),
            "{:?}",
            plan.textures
        );
        assert!(!plan.draws.is_empty());
    }
}

#[test]
fn steps_end_on_frames_and_resolve_the_contact() {
    let scene = common::scene(3, &["time.steps_per_contact=40"]);
    let plan = plan(&scene, &Wanted::default());
    let frame = f64::from(plan.steps_per_frame) * plan.time_step_s;
    assert!((frame - 1.0 / scene.time.fps).abs() < 1e-12);
    // Duration of a contact of two grains: π / (ω0 √(1 - β²)), ω0² = 2k/m.
    let (k, m, e) = (
        scene.grains().unwrap().contact.spring,
        scene.grains().unwrap().mass,
        0.6f64,
    );
    let beta = -e.ln() / (std::f64::consts::PI.powi(2) + e.ln().powi(2)).sqrt();
    let duration = std::f64::consts::PI / ((2.0 * k / m).sqrt() * (1.0 - beta * beta).sqrt());
    assert!(
        (scene.time.contact_duration.unwrap() - duration).abs() < 1e-9 * duration,
        "{}",
        scene.time.contact_duration.unwrap()
    );
    assert!(plan.time_step_s <= duration / 40.0);
}

#[test]
fn what_does_not_fit_is_refused_with_the_number_that_would() {
    let scene = common::scene(
        3,
        &[
            "neighbors.addressing=uniform",
            "neighbors.storage=pool",
            "neighbors.slots=64",
        ],
    );
    let small = Limits {
        binding: 1 << 19,
        ..Limits::PROMISED
    };
    let error = Plan::new(&scene, &small, &Wanted::default()).expect_err("too large");
    let Error::Limit { what, help } = error else {
        panic!("{error}")
    };
    assert!(what.contains("index_pool") && what.contains("524288"), "{what}");
    assert!(help.contains("2048 voxels would fit"), "{help}");

    let small = Limits {
        binding: 4000,
        ..Limits::PROMISED
    };
    let scene = common::scene(2, &["neighbors.storage=counting"]);
    let Error::Limit { help, .. } = Plan::new(&scene, &small, &Wanted::default()).expect_err("too large")
    else {
        panic!("another error");
    };
    assert!(help.contains("500 particles would fit"), "{help}");
}
