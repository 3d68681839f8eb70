//! A scene pays only for what it models. Plans need no GPU.

use std::path::Path;

use sliceflow::error::Error;
use sliceflow::gpu::{Limits, Shader};
use sliceflow::neighbors::{Room, STORAGES, first_grid, lists};
use sliceflow::output::columns_named;
use sliceflow::plan::{Phase, Plan, Wanted};
use sliceflow::scene::column::{COLUMNS, Source};
use sliceflow::scene::model::View;
use sliceflow::scene::{Scene, library, load};

use crate::common;

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
    // A vector and a number beside it, as in space.
    let position = flat.buffers.iter().find(|b| b.name == "position").unwrap();
    assert_eq!(position.bytes, 16 * u64::from(scene.capacity));
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
    assert!(help.contains("250 particles would fit"), "{help}");
}

/// Limits that bind no buffer of more bytes.
fn binding(bytes: u64) -> Limits {
    Limits {
        binding: bytes,
        ..Limits::PROMISED
    }
}

fn bytes_of(plan: &Plan, name: &str) -> Option<u64> {
    plan.buffers.iter().find(|b| b.name == name).map(|b| b.bytes)
}

#[test]
fn lists_are_as_long_as_fits_and_left_out_where_the_usual_ones_do_not() {
    for dimensions in [2, 3] {
        for scene in [common::scene(dimensions, &[]), common::fluid(dimensions, &[])] {
            let usual = lists::usual_length(&scene);
            let roomy = plan(&scene, &Wanted::default());
            assert!(roomy.grid.list_capacity > usual);
            let of = |list: u32, reached: u32| {
                let room = Room {
                    list,
                    reached,
                    ..Default::default()
                };
                lists::buffers(&scene, room)[0].bytes
            };
            let of_length = |length: u32| of(length, roomy.grid.reached_capacity);
            assert_eq!(
                bytes_of(&roomy, "neighbor_list"),
                Some(of_length(roomy.grid.list_capacity))
            );
            for length in [usual, usual + 1] {
                let fitted = Plan::new(&scene, &binding(of_length(length)), &Wanted::default()).unwrap();
                assert_eq!(fitted.lists_left_out, None);
                assert_eq!(bytes_of(&fitted, "neighbor_list"), Some(of_length(length)));
            }
            // Where there is no room for more boundary particles than are in reach, lists are there all the same.
            let least = of(usual, lists::reached_at_start(&scene, &roomy.grid));
            let fitted = Plan::new(&scene, &binding(least), &Wanted::default()).unwrap();
            assert_eq!(bytes_of(&fitted, "neighbor_list"), Some(least));
            let small = binding(least - 1);
            let fitted = Plan::new(&scene, &small, &Wanted::default()).unwrap();
            let told = fitted.lists_left_out.clone().expect("it says so");
            assert!(
                told.contains(&format!("{least} bytes")) && told.contains("without lists"),
                "{told}"
            );
            assert!(fitted.told().any(|note| *note == told));
            // It is the plan of the scene that asks for none.
            let unlisted = Plan {
                lists_left_out: Some(told),
                ..Plan::new(&lists::without(&scene), &small, &Wanted::default()).unwrap()
            };
            assert_eq!(serde_json::json!(fitted), serde_json::json!(unlisted));
            assert_eq!((fitted.grid, &fitted.variant), (unlisted.grid, &unlisted.variant));
            assert!(fitted.with_its_lists().is_err());
        }
    }
}

#[test]
fn scenes_that_need_lists_are_refused_where_these_do_not_fit() {
    for (scene, need) in [
        (
            common::scene(2, &["time.adaptive=true"]),
            "adaptive steps need lists",
        ),
        (
            common::fluid(2, &["domain.walls=periodic", "colliders=[]"]),
            "periodic sides need lists",
        ),
        (
            common::fluid(2, &["fluid.solver=dfsph"]),
            "the solver `dfsph` needs lists",
        ),
    ] {
        let usual = lists::usual_length(&scene);
        let room = Room {
            list: usual,
            reached: lists::reached_at_start(&scene, &first_grid(&scene)),
            ..Default::default()
        };
        let small = binding(lists::buffers(&scene, room)[0].bytes - 1);
        let error = Plan::new(&scene, &small, &Wanted::default()).expect_err("no room");
        let Error::Limit { what, help } = error else {
            panic!("{error}")
        };
        assert!(what.ends_with(need), "{what}");
        assert!(help.contains("sliceflow devices"), "{help}");
    }
}

#[test]
fn passes_and_draws_say_what_they_take_of_an_adapter() {
    let scene = common::scene(3, &[]);
    let wanted = Wanted {
        view: Some(View::Both),
        ..Default::default()
    };
    let plan = plan(&scene, &wanted);
    for row in &plan.passes {
        let shader = Shader::load(&row.pass.shader, &plan.variant_of(row.phase)).unwrap();
        assert_eq!(
            row.demand,
            shader.demand(&[&row.pass.entry]).unwrap(),
            "{}",
            row.pass.entry
        );
        assert!(
            row.demand.storage_buffers > 0 && row.demand.threads > 0,
            "{row:?}"
        );
    }
    // A stage of a draw binds what it uses itself.
    let sphere = plan
        .draws
        .iter()
        .find(|draw| draw.label == "place_sphere")
        .unwrap();
    assert_eq!(sphere.fragment.as_deref(), Some("shade_sphere"));
    assert!(
        sphere.demand.bindings > sphere.demand.storage_buffers && sphere.demand.textures > 0,
        "{sphere:?}"
    );
    // The scan shares one word per thread, and one per 16 threads and for the total.
    let scan = plan
        .passes
        .iter()
        .map(|row| row.demand)
        .find(|d| d.threads == 256)
        .unwrap();
    assert_eq!(scan.group_bytes, 4 * (256 + 256 / 16 + 1));

    let (label, most) = plan.most_storage_buffers();
    let enough = Limits {
        storage_buffers: most,
        ..Limits::PROMISED
    };
    Plan::new(&scene, &enough, &wanted).expect("exactly enough");
    let scarce = Limits {
        storage_buffers: most - 1,
        ..Limits::PROMISED
    };
    let error = Plan::new(&scene, &scarce, &wanted).expect_err("one is missing");
    let expected = format!(
        "pass `{label}` binds {most} storage buffers; this adapter allows {}",
        most - 1
    );
    assert!(error.to_string().starts_with(&expected), "{error}");
}

#[test]
fn everything_that_an_adapter_limits_is_checked() {
    let scene = common::scene(3, &[]);
    let wanted = pictures();
    type Lower = fn(&mut Limits);
    let rows: [(Lower, &str); 11] = [
        (|l| l.storage_buffers = 1, "storage buffers"),
        (|l| l.uniform_buffers = 0, "uniform buffers"),
        (|l| l.textures = 0, "textures"),
        (|l| l.samplers = 0, "samplers"),
        (|l| l.bindings = 2, "resources"),
        (|l| l.binding = 1000, "binds at most 1000 at once"),
        (|l| l.uniform = 16, "uniform buffer"),
        (|l| l.buffer = 1000, "binds at most 1000 at once"),
        (|l| l.threads = 128, "threads in a workgroup"),
        (|l| l.group_bytes = 512, "bytes in a workgroup"),
        (|l| l.groups = 1, "workgroups"),
    ];
    for (lower, told) in rows {
        let mut limits = Limits::PROMISED;
        lower(&mut limits);
        let error = Plan::new(&scene, &limits, &wanted).expect_err(told).to_string();
        assert!(error.contains(told) && error.contains("help: "), "{error}");
    }
}

/// WebGPU promises 8 storage buffers per stage everywhere.
#[test]
fn no_pass_of_a_shipped_scene_binds_more_than_8_storage_buffers() {
    let columns = COLUMNS.iter().copied().filter(|c| c.source == Source::Measured);
    let measured: Vec<_> = columns.collect();
    let mut most = 0;
    for name in library::names() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("assets/scenes/{name}.json"));
        let scene = load::load(&file, &[]).expect("shipped scenes are sound");
        let wanted = Wanted {
            statistics: true,
            columns: measured.clone(),
            view: Some(View::Both),
            voxel_map: Some(64),
            sensors: !scene.sensors.list.is_empty(),
            ..Default::default()
        };
        let limits = Limits {
            storage_buffers: 8,
            ..Limits::PROMISED
        };
        match Plan::new(&scene, &limits, &wanted) {
            Ok(plan) => most = plan.most_storage_buffers().1.max(most),
            Err(error) => panic!("{name}: {error}"),
        }
    }
    assert!(most > 4, "{most}: nothing was counted");
}
