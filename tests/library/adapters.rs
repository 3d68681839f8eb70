//! Adapters with little room: whatever one lacks is a clear refusal or a run that does without, and never a panic.

use std::path::Path;
use std::process::Command;

use glam::Vec3;
use sliceflow::error::Error;
use sliceflow::gpu::buffers::Usage;
use sliceflow::gpu::{AdapterChoice, Buffers, Gpu};
use sliceflow::output::columns_named;
use sliceflow::plan::{Plan, Wanted};
use sliceflow::scene::Scene;
use sliceflow::simulation::{Frame, Simulation, State};

use crate::common::{self, frames};

/// The test adapter with lower limits, with all checks in the shaders.
fn lesser(limits: &str) -> Gpu {
    Gpu::open_within(&AdapterChoice::Best, true, |offered| offered.lowered(limits)).expect("an adapter")
}

fn wanted() -> Wanted {
    Wanted {
        statistics: true,
        columns: columns_named(["position", "velocity"]).expect("columns"),
        ..Default::default()
    }
}

fn simulate(limits: &str, scene: &Scene, wanted: &Wanted) -> Simulation {
    let gpu = lesser(limits);
    let plan = Plan::new(scene, &gpu.limits, wanted).expect("a plan");
    Simulation::new(gpu, scene, &plan).expect("a simulation")
}

fn assert_same(one: &[Frame], two: &[Frame], what: &str) {
    assert_eq!(one.len(), two.len(), "{what}");
    for (one, two) in one.iter().zip(two) {
        assert_eq!(
            (one.index, one.steps, one.statistics),
            (two.index, two.steps, two.statistics),
            "{what}"
        );
        for (a, b) in one.columns.iter().zip(&two.columns) {
            assert!(a == b, "{what}, frame {}: {} differs", one.index, a.name);
        }
        assert!(
            one.pixels == two.pixels,
            "{what}, frame {}: pixels differ",
            one.index
        );
    }
}

/// The limit that leaves room for lists of so many neighbors, and for no more.
fn room_for_lists(scene: &Scene, length: u32) -> String {
    let grid = sliceflow::neighbors::first_grid(scene);
    let room = sliceflow::neighbors::Room {
        list: length,
        reached: sliceflow::neighbors::lists::reached_at_start(scene, &grid),
        ..Default::default()
    };
    format!(
        "binding={}",
        sliceflow::neighbors::lists::buffers(scene, room)[0].bytes
    )
}

#[test]
fn a_run_whose_lists_do_not_fit_is_the_run_without_lists() {
    let small = "render.size=[64,48]";
    for scene in [
        common::scene(2, &[small]),
        common::scene(3, &[small]),
        common::fluid(2, &[small, "colliders=[]"]),
    ] {
        let wanted = wanted();
        let usual = sliceflow::neighbors::lists::usual_length(&scene);
        let limits = room_for_lists(&scene, usual - 1);
        let mut lesser = simulate(&limits, &scene, &wanted);
        let without = frames(&mut lesser, 2);
        let told = without[0].lists_left_out.as_deref().expect("it says so");
        assert!(told.contains(&format!("lists of {usual} neighbors")), "{told}");
        let unlisted = sliceflow::neighbors::lists::without(&scene);
        let chosen = frames(&mut common::simulate(&unlisted, &wanted), 2);
        assert_eq!(chosen[0].lists_left_out, None);
        assert_same(&without, &chosen, &scene.name);
    }
}

/// Grains that fly towards each other, so that their lists grow, but not at once.
fn implosion(dimensions: usize) -> Scene {
    let base = common::scene(dimensions, &[]);
    let diameter = 2.0 * base.radius() as f32;
    let side = if dimensions == 2 { 20 } else { 7 };
    let layers = if dimensions == 2 { 1 } else { side };
    let mut position = Vec::new();
    for x in 0..side {
        for y in 0..side {
            for z in 0..layers {
                let at = Vec3::new(x as f32, y as f32, z as f32) - 0.5 * (side as f32 - 1.0);
                position.push(
                    at * 1.6
                        * diameter
                        * if layers == 1 {
                            Vec3::new(1.0, 1.0, 0.0)
                        } else {
                            Vec3::ONE
                        },
                );
            }
        }
    }
    let velocity = position.iter().map(|&at| -6.0 * at).collect();
    common::open_scene(
        dimensions,
        &[
            "neighbors.margin=1",
            "neighbors.skin=0.4",
            "grains.spring=200",
            "time.fps=60",
        ],
        position,
        velocity,
    )
}

#[test]
fn lists_that_grow_out_of_an_adapter_are_left_out_and_the_run_goes_on() {
    for dimensions in [2, 3] {
        let scene = implosion(dimensions);
        let limits = room_for_lists(&scene, sliceflow::neighbors::lists::usual_length(&scene));
        let last = 9;
        let whole = frames(&mut simulate(&limits, &scene, &wanted()), last);
        let given_up = whole.iter().position(|frame| frame.lists_left_out.is_some());
        let given_up = given_up.expect("lists outgrow the adapter") as u32;
        assert!((2..last).contains(&given_up), "in frame {given_up}");
        assert_eq!(
            whole[last as usize].steps,
            u64::from(last * scene.time.steps_per_frame)
        );
        // It is the same motion as with lists.
        let listed = frames(&mut common::simulate(&scene, &wanted()), last);
        let energy = |frames: &[Frame]| frames[last as usize].statistics.unwrap().kinetic_energy;
        let (without, with) = (energy(&whole), energy(&listed));
        assert!(
            (without / with - 1.0).abs() < 0.02,
            "{without} J, {with} J with lists"
        );
        // It is the same run wherever it is taken up again.
        for middle in [given_up - 1, given_up, given_up + 1] {
            let mut first = simulate(&limits, &scene, &wanted());
            assert_same(
                &frames(&mut first, middle),
                &whole[..=middle as usize],
                "the first half",
            );
            let state: State = first.save_state().expect("a state");
            assert_eq!(state.lists_left_out.is_some(), middle >= given_up);
            let mut second = simulate(&limits, &scene, &wanted());
            second.restore(&state).expect("restored");
            let rest = frames(&mut second, last);
            assert_same(&rest, &whole[middle as usize + 1..], "the second half");
        }
    }
}

/// Passes of listed steps are timed in pairs; lists may be left out in between.
#[test]
fn timed_steps_may_lose_their_lists() {
    let scene = implosion(2);
    let limits = room_for_lists(&scene, sliceflow::neighbors::lists::usual_length(&scene));
    let mut simulation = simulate(&limits, &scene, &wanted());
    simulation.set_timings(true);
    let frames = frames(&mut simulation, 9);
    assert!(frames[9].lists_left_out.is_some());
    assert_eq!(frames[9].steps, u64::from(9 * scene.time.steps_per_frame));
    assert!(frames[1..].iter().all(|frame| !frame.pass_ms.is_empty()));
}

#[test]
fn a_run_goes_on_without_lists_on_a_lesser_adapter_than_it_began_on() {
    let scene = common::scene(2, &[]);
    let mut first = common::simulate(&scene, &wanted());
    frames(&mut first, 1);
    let state = first.save_state().expect("a state");
    assert_eq!(state.lists_left_out, None);
    let usual = sliceflow::neighbors::lists::usual_length(&scene);
    let mut second = simulate(&room_for_lists(&scene, usual - 1), &scene, &wanted());
    second.restore(&state).expect("restored");
    let rest = frames(&mut second, 2);
    assert!(rest[0].lists_left_out.is_some());
    assert_eq!(rest[0].steps, u64::from(2 * scene.time.steps_per_frame));
}

/// A simulation on a device that no other test gets.
fn breakable(scene: &Scene) -> Simulation {
    let gpu = Gpu::open(&AdapterChoice::Best, true).expect("an adapter");
    let plan = Plan::new(scene, &gpu.limits, &wanted()).expect("a plan");
    Simulation::new(gpu, scene, &plan).expect("a simulation")
}

#[test]
fn a_lost_device_ends_a_run_with_frame_and_step() {
    for skin in ["neighbors.skin=0", "neighbors.skin=0.1"] {
        let scene = common::scene(2, &[skin]);
        let mut simulation = breakable(&scene);
        frames(&mut simulation, 1);
        simulation.gpu().device.destroy();
        let error = loop {
            if let Err(error) = simulation.next_frame() {
                break error;
            }
        };
        let text = error.to_string();
        assert!(
            matches!(error, Error::Device { .. }) && error.exit_code() == 1,
            "{text}"
        );
        assert!(
            text.starts_with("at frame 2, step ") && text.contains("the device was lost"),
            "{text}"
        );
        assert!(simulation.save_state().is_err());
    }
}

#[test]
fn what_the_device_refuses_ends_a_run_with_frame_and_step() {
    let scene = common::scene(2, &[]);
    let mut simulation = breakable(&scene);
    let made = frames(&mut simulation, 1);
    assert_eq!(made.len(), 2);
    // A copy beyond the end of a buffer is an error that wgpu reports out of band.
    let gpu = simulation.gpu().clone();
    let guard = simulation.buffers().get("guard", "(test)").unwrap().clone();
    gpu.queue.write_buffer(&guard, 1 << 20, &[0; 4]);
    let error = simulation
        .next_frame()
        .expect_err("the error is found")
        .to_string();
    assert!(error.starts_with("at frame 2, step "), "{error}");
    assert!(
        error.contains("refused a command") && error.contains("help: "),
        "{error}"
    );
}

#[test]
fn a_buffer_without_room_is_named_with_its_bytes() {
    let gpu = lesser("buffer=1MiB");
    let mut buffers = Buffers::default();
    let error = buffers.create(&gpu, "position", 2 << 20, Usage::Storage);
    let error = error.expect_err("too large").to_string();
    assert!(error.contains("buffer `position` of 2097152 bytes"), "{error}");
    // Nothing else is wrong with the device.
    buffers
        .create(&gpu, "position", 1 << 20, Usage::Storage)
        .expect("it fits");
    gpu.wait(None).expect("nothing is kept of it");
}

/// A folder with a short run, a cloud of points, and the program run in it.
struct Place(tempfile::TempDir);

impl Place {
    fn new() -> Self {
        let place = Self(tempfile::tempdir().unwrap());
        let points: String = (0..200).map(|i| format!("{},{},0\n", i % 20, i / 20)).collect();
        std::fs::write(place.0.path().join("points.csv"), format!("x,y,z\n{points}")).unwrap();
        let run = [
            "run",
            "column_2d",
            "--out",
            "done",
            "--frames",
            "2",
            "--fps",
            "1000",
            "--size",
            "64x48",
        ];
        let (status, told) = place.told(&run, "");
        assert_eq!(status, 0, "{told}");
        place
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    /// Exit status and standard error of the program on an adapter with lower limits.
    fn told(&self, args: &[&str], limits: &str) -> (i32, String) {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("sliceflow"));
        command
            .current_dir(self.path())
            .args(args)
            .env("SLICEFLOW_LIMITS", limits);
        let output = command.output().unwrap();
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        (output.status.code().expect("no signal"), told)
    }
}

/// Every command that opens a device.
const COMMANDS: [&[&str]; 9] = [
    &[
        "run",
        "column_2d",
        "--out",
        "new",
        "--frames",
        "2",
        "--fps",
        "1000",
        "--size",
        "64x48",
    ],
    &["run", "column_2d", "--dry-run"],
    &["plan", "column_2d"],
    &["resume", "done", "--frames", "4"],
    &[
        "resume",
        "done",
        "--branch-at",
        "1",
        "--frames",
        "4",
        "--out",
        "new",
    ],
    &["render", "done", "--out", "new"],
    &["inspect", "column_2d", "--frame", "0"],
    &["neighbors", "points.csv", "--radius", "1.5", "--lists", "pairs"],
    &["study", "rojas", "--scale", "tiny", "--out", "new", "--force"],
];

#[test]
fn every_command_refuses_what_an_adapter_lacks() {
    let place = Place::new();
    // The last one is what the message says of it.
    for (limits, told) in [
        ("storage_buffers=2", "storage buffers; this adapter allows 2"),
        ("uniform_buffers=0", "uniform buffers; this adapter allows 0"),
        ("bindings=3", "resources; this adapter allows 3"),
        ("binding=512", "this adapter binds at most 512 at once"),
        ("buffer=1KiB", "this adapter binds at most 1024 at once"),
        ("uniform=16", "this adapter binds at most 16 at once"),
        ("threads=32", "threads in a workgroup; this adapter allows 32"),
        ("group_bytes=64", "bytes in a workgroup; this adapter allows 64"),
        ("groups=1", "workgroups; this adapter runs at most 1 at once"),
        ("threads=few", "SLICEFLOW_LIMITS has `threads=few`"),
    ] {
        for command in COMMANDS {
            let (status, error) = place.told(command, limits);
            let what = format!("{limits}, {command:?}: {error}");
            assert!(
                !error.contains("panicked") && !error.contains("backtrace"),
                "{what}"
            );
            assert_eq!(status, if limits.contains("few") { 2 } else { 1 }, "{what}");
            assert!(error.contains(told) && error.contains("help: "), "{what}");
        }
    }
    assert!(!place.path().join("new").join("run.json").exists());
}

#[test]
fn pictures_too_are_refused_where_an_adapter_lacks_something() {
    let place = Place::new();
    for (limits, told) in [
        ("texture=32", "texture `scene_color` needs"),
        ("textures=0", "textures; this adapter allows 0"),
        ("samplers=0", "samplers; this adapter allows 0"),
    ] {
        let (status, error) = place.told(&["plan", "green_cube"], limits);
        assert!(status == 1 && error.contains(told), "{limits}: {error}");
    }
}

#[test]
fn devices_are_listed_with_lowered_limits() {
    let mut devices = Command::new(assert_cmd::cargo::cargo_bin!("sliceflow"));
    devices.args(["devices", "--json"]);
    let listed = devices
        .env("SLICEFLOW_LIMITS", "storage_buffers=5")
        .output()
        .unwrap();
    let listed: serde_json::Value = serde_json::from_slice(&listed.stdout).unwrap();
    assert_eq!(listed[0]["storage_buffers"], 5);
    let refused = devices.env("SLICEFLOW_LIMITS", "nothing=5").output().unwrap();
    let told = String::from_utf8_lossy(&refused.stderr);
    assert!(
        refused.status.code() == Some(2) && told.contains("storage_buffers"),
        "{told}"
    );
}
