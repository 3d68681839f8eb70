//! The program as a user meets it: arguments, messages, exit status, files.

#![cfg(all(feature = "cli", feature = "plots", feature = "surface", feature = "video"))]

use std::fs;
use std::path::Path;

use assert_cmd::{Command, cargo_bin_cmd};
use serde_json::Value;
use sliceflow::scene::npy::Array;

fn sliceflow(args: &[&str]) -> Command {
    let mut command = cargo_bin_cmd!("sliceflow");
    command.args(args);
    command
}

/// Standard output of a command that succeeds.
fn output(args: &[&str]) -> String {
    let assert = sliceflow(args).assert().success();
    String::from_utf8(assert.get_output().stdout.clone()).unwrap()
}

fn json(args: &[&str]) -> Value {
    serde_json::from_str(&output(args)).unwrap()
}

/// Standard error of a command that fails with this exit status.
fn failure(args: &[&str], status: i32) -> String {
    let assert = sliceflow(args).assert().code(status);
    String::from_utf8(assert.get_output().stderr.clone()).unwrap()
}

fn read_json(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

/// A checkpoint at the end of a run and none before, however long it takes.
const ONE_CHECKPOINT: [&str; 2] = ["--checkpoint-every", "1000000"];

/// A short run: three small frames of 2,000 discs.
fn short_run<'a>(out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let mut args = vec![
        "run",
        "column_2d",
        "--out",
        out,
        "--frames",
        "3",
        "--fps",
        "1000",
        "--size",
        "160x120",
    ];
    args.extend(ONE_CHECKPOINT);
    args.extend(more);
    args
}

#[test]
fn help_has_examples() {
    for command in [
        "run",
        "resume",
        "render",
        "diff",
        "plan",
        "inspect",
        "neighbors",
        "scenes",
        "schema",
        "devices",
        "surface",
        "usd",
        "import",
        "new",
        "study",
        "bench",
        "completions",
    ] {
        let help = output(&[command, "--help"]);
        assert!(
            help.contains("Examples:") && help.contains(&format!("sliceflow {command}")),
            "{help}"
        );
        assert!(output(&["--help"]).contains(command));
    }
}

#[test]
fn help_is_plain_where_colors_are_not_wanted() {
    let assert = sliceflow(&["--help"])
        .env("NO_COLOR", "1")
        .env("CLICOLOR_FORCE", "0")
        .assert()
        .success();
    assert!(!assert.get_output().stdout.contains(&0x1b));
}

#[test]
fn unknown_commands_and_arguments_exit_with_2() {
    assert!(failure(&["insepct"], 2).contains("inspect"));
    failure(&[], 2);
    failure(&["run", "column_2d", "--size", "big"], 2);
    failure(&["run", "column_2d", "--frames", "0"], 2);
    failure(&["run", "column_2d", "--columns", "id"], 2);
    failure(&["run", "column_2d", "--particles-every", "2"], 2);
    assert!(failure(&["run", "column_2d", "--particles", "ply,csv"], 2).contains("bgeo"));
    assert!(failure(&["plan", "column_2d", "--video", "a.avi"], 2).contains(".webm"));
}

#[test]
fn unknown_scenes_columns_and_grids_are_told_with_what_there_is() {
    assert!(failure(&["run", "column_3d"], 2).contains("column_2d"));
    assert!(
        failure(
            &["plan", "column_2d", "--particles", "npy", "--columns", "mass"],
            2
        )
        .contains("position")
    );
    assert!(failure(&["plan", "column_2d", "--grid", "pool"], 2).contains("sliced-pool"));
    assert!(failure(&["plan", "column_2d", "--grid", "sliced-heap"], 2).contains("neighbors.storage"));
    assert!(failure(&["plan", "column_2d", "--set", "grains.radios=1"], 2).contains("radius"));
}

#[test]
fn schema_explains_what_runs_write() {
    let explained = output(&["schema", "--of", "stats", "density_error_mean"]);
    assert!(
        explained.starts_with("density_error_mean: a number; not always there\n"),
        "{explained}"
    );
    let explained = output(&["schema", "--of", "run", "status"]);
    assert!(
        explained.contains("always there") && explained.contains("interrupted"),
        "{explained}"
    );
    assert!(json(&["schema", "--of", "run"])["properties"]["configuration"].is_object());
    assert!(failure(&["schema", "--of", "stats", "gravity"], 2).contains("stats.jsonl"));
}

#[test]
fn schema_describes_every_key_of_a_scene() {
    let schema = json(&["schema"]);
    for key in [
        "domain",
        "grains",
        "bodies",
        "events",
        "neighbors",
        "time",
        "render",
    ] {
        assert!(schema["properties"][key].is_object(), "{key}");
    }
}

#[test]
fn scenes_columns_and_color_maps_are_listed() {
    let scenes = json(&["scenes", "--json"]);
    assert!(
        scenes
            .as_array()
            .unwrap()
            .iter()
            .all(|scene| !scene["source"].as_str().unwrap().is_empty())
    );
    assert!(output(&["scenes"]).contains("column_2d (2,000 particles)"));
    assert!(output(&["scenes", "--columns"]).contains("kg/m³"));
    assert!(output(&["scenes", "--color-maps"]).contains("viridis"));
}

#[test]
fn devices_are_listed_with_what_a_plan_asks() {
    let devices = json(&["devices", "--json"]);
    let first = &devices[0];
    assert_eq!(first["index"], 0);
    assert!(first["binding_bytes"].as_u64().unwrap() >= 128 << 20, "{first}");
    assert!(output(&["devices"]).contains(first["name"].as_str().unwrap()));
}

#[test]
fn an_adapter_that_is_not_there_is_told_with_those_that_are() {
    let name = json(&["devices", "--json"])[0]["name"]
        .as_str()
        .unwrap()
        .to_owned();
    for wrong in ["no such adapter", "99"] {
        let message = failure(&["plan", "column_2d", "--adapter", wrong], 1);
        assert!(message.contains(wrong) && message.contains(&name), "{message}");
    }
}

#[test]
fn a_machine_without_adapters_plans_and_says_how_to_get_one() {
    let none = |args: &[&str]| {
        sliceflow(args)
            .env("VK_DRIVER_FILES", "/none")
            .env("VK_ICD_FILENAMES", "/none")
            .assert()
    };
    let planned = none(&["plan", "column_2d", "--json"]).success();
    let plan: Value = serde_json::from_slice(&planned.get_output().stdout).unwrap();
    assert_eq!(plan["adapter"], Value::Null);
    for args in [&["devices"][..], &["inspect", "column_2d"]] {
        let failed = none(args).code(1);
        assert!(String::from_utf8_lossy(&failed.get_output().stderr).contains("mesa-vulkan-drivers"));
    }
}

#[test]
fn a_plan_names_buffers_and_passes_and_says_why() {
    let plan = json(&["plan", "column_2d", "--json", "--frames", "31"]);
    assert_eq!(plan["frames"], 31);
    assert_eq!(plan["particles"], 2000);
    let buffers = plan["plan"]["buffers"].as_array().unwrap();
    let passes = plan["plan"]["passes"].as_array().unwrap();
    assert!(!buffers.is_empty() && !passes.is_empty());
    assert!(
        buffers
            .iter()
            .chain(passes)
            .all(|row| !row["why"].as_str().unwrap().is_empty())
    );
    assert_eq!(
        plan["steps"].as_u64().unwrap(),
        30 * plan["steps_per_frame"].as_u64().unwrap()
    );

    let text = output(&["run", "column_2d", "--dry-run"]);
    assert!(
        text.contains("limited by") && text.contains("particles  2,000"),
        "{text}"
    );
}

#[test]
fn a_plan_says_which_solver_a_fluid_gets_and_why() {
    let solver = |args: &[&str]| {
        let text = output(&[&["plan", "harada_dam"], args].concat());
        let line = text.lines().find(|line| line.starts_with("solver "));
        line.map(str::to_owned).unwrap_or_else(|| panic!("{text}"))
    };
    let default = solver(&[]);
    assert!(
        default.contains("dfsph, the default") && default.contains("incompressible"),
        "{default}"
    );
    assert!(!default.contains("viscosity"), "{default}");
    let honey = solver(&["--set", "fluid.viscosity=100"]);
    assert!(honey.contains("viscosity is implicit"), "{honey}");
    let asked = solver(&["--set", "fluid.solver=wcsph"]);
    assert!(
        asked.contains("wcsph, which the scene asks for") && asked.contains("sound"),
        "{asked}"
    );
    assert!(!output(&["plan", "column_2d"]).contains("\nsolver "));
}

#[test]
fn fewer_outputs_need_less_disk() {
    let disk = |more: &[&str]| {
        json(&[&["plan", "column_2d", "--json"], more].concat())["disk_bytes_estimate"]
            .as_u64()
            .unwrap()
    };
    assert_eq!(
        disk(&["--no-pictures", "--no-statistics", "--checkpoint-every", "0"]),
        0
    );
    assert!(disk(&["--checkpoint-every", "0"]) < disk(&[]));
    assert!(disk(&["--no-pictures"]) < disk(&[]));
    assert!(disk(&[]) < disk(&["--particles", "npy"]));
    assert!(disk(&["--particles", "npy"]) < disk(&["--particles", "npy,vtk"]));
    assert!(disk(&["--particles", "npy", "--particles-every", "2"]) < disk(&["--particles", "npy"]));
    assert!(disk(&[]) < disk(&["--video", "a.gif"]));
}

#[test]
fn a_run_writes_frames_statistics_particles_and_a_manifest() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let columns = [
        "--particles",
        "npy",
        "--columns",
        "position,id",
        "--progress",
        "json",
    ];
    let assert = sliceflow(&short_run(out.to_str().unwrap(), &columns))
        .assert()
        .success();
    assert!(assert.get_output().stdout.is_empty());

    for frame in 0..3 {
        let picture = image::open(out.join(format!("frame_{frame:06}.png"))).unwrap();
        assert_eq!((picture.width(), picture.height()), (160, 120));
        let arrays = out.join(format!("particles_{frame:06}"));
        let shape = |name: &str| Array::parse(&fs::read(arrays.join(name)).unwrap()).unwrap().shape;
        assert_eq!(shape("position.npy")[0], 2000);
        assert_eq!(shape("id.npy"), [2000]);
    }
    assert_eq!(
        fs::read_dir(&out).unwrap().count(),
        3 + 3 + 3,
        "no frame too many, no partial file left"
    );

    let statistics = fs::read_to_string(out.join("stats.jsonl")).unwrap();
    let lines: Vec<Value> = statistics
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    assert_eq!(lines.len(), 3);
    assert_eq!(lines[2]["frame"], 2);
    assert!((lines[2]["time_s"].as_f64().unwrap() - 2e-3).abs() < 1e-9);

    let manifest = read_json(&out.join("run.json"));
    assert_eq!(manifest["status"], "finished");
    assert_eq!(manifest["frames_done"], 3);
    assert_eq!(manifest["scene"]["time"]["fps"], 1000.0);
    assert_eq!(
        manifest["particle_steps"].as_u64().unwrap(),
        2000 * lines[2]["steps"].as_u64().unwrap()
    );

    let log = String::from_utf8(assert.get_output().stderr.clone()).unwrap();
    let events = log
        .lines()
        .map(|line| serde_json::from_str::<Value>(line).unwrap());
    assert_eq!(events.filter(|event| event["event"] == "frame").count(), 3);
}

#[test]
fn an_earlier_run_is_replaced_only_with_force() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let first = [
        "run",
        "column_2d",
        "--out",
        out,
        "--frames",
        "3",
        "--fps",
        "1000",
        "--size",
        "80x60",
    ];
    sliceflow(&first).assert().success();
    for mine in ["notes.txt", "frame_000007.png"] {
        fs::write(folder.path().join(mine), "mine").unwrap();
    }
    let old = fs::read(folder.path().join("frame_000000.png")).unwrap();
    let message = failure(&short_run(out, &[]), 2);
    assert!(
        message.contains("3 frames") && message.contains("--force"),
        "{message}"
    );
    assert_eq!(fs::read(folder.path().join("frame_000000.png")).unwrap(), old);

    let fewer = [
        "run",
        "column_2d",
        "--out",
        out,
        "--frames",
        "2",
        "--fps",
        "1000",
        "--force",
    ];
    let assert = sliceflow(&fewer).assert().success();
    let told = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
    assert!(
        told.contains("removed") && told.contains("frame_000007.png"),
        "{told}"
    );
    assert!(
        !folder.path().join("frame_000002.png").exists(),
        "beyond the new run's frames"
    );
    assert!(
        folder.path().join("frame_000007.png").exists(),
        "no run has recorded it"
    );
    assert_eq!(
        fs::read_to_string(folder.path().join("notes.txt")).unwrap(),
        "mine"
    );
    assert_ne!(fs::read(folder.path().join("frame_000000.png")).unwrap(), old);
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_keeps_its_frames_and_says_so() {
    use std::process::{Command, Stdio};

    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let args = [
        "run",
        "column_2d",
        "--out",
        out,
        "--frames",
        "100000",
        "--fps",
        "1000",
        "--size",
        "64x48",
    ];
    let program = assert_cmd::cargo::cargo_bin!("sliceflow");
    let mut run = Command::new(program)
        .args(args)
        .args(ONE_CHECKPOINT)
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    while !folder.path().join("frame_000001.png").exists() {
        assert!(run.try_wait().unwrap().is_none(), "it ended by itself");
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    Command::new("kill")
        .args(["-INT", &run.id().to_string()])
        .status()
        .unwrap();
    assert_eq!(run.wait().unwrap().code(), Some(130));

    let manifest = read_json(&folder.path().join("run.json"));
    assert_eq!(manifest["status"], "interrupted");
    let frames = manifest["frames_done"].as_u64().unwrap();
    assert_eq!(fs::read_dir(folder.path()).unwrap().count() as u64, frames + 3);
    assert_eq!(
        fs::read_to_string(folder.path().join("stats.jsonl"))
            .unwrap()
            .lines()
            .count() as u64,
        frames
    );
}

#[test]
fn a_folder_that_cannot_be_written_is_told_before_anything_runs() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    let out = file.join("out");
    let message = failure(&short_run(out.to_str().unwrap(), &[]), 1);
    assert!(
        message.contains(out.to_str().unwrap()) && message.contains("--out"),
        "{message}"
    );
    assert!(!message.contains("frame"), "{message}");
}

#[test]
fn inspect_compares_grids() {
    let grids = ["uniform-pool", "sliced-pool", "rows-counting"];
    let mut args = vec![
        "inspect",
        "column_2d",
        "--frame",
        "2",
        "--every",
        "2",
        "--json",
        "--grid",
    ];
    args.extend(grids);
    let found = json(&args);
    let number = |value: &Value| value.as_u64().unwrap_or_else(|| panic!("no number: {value}"));
    let per_grid = found["grids"].as_array().unwrap();
    let names: Vec<_> = per_grid.iter().map(|one| one["grid"].as_str().unwrap()).collect();
    assert_eq!(names, grids);
    for one in per_grid {
        assert_eq!(one["counted_on"], "device");
        for key in [
            "voxels_occupied",
            "voxels_with_1",
            "voxels_with_4",
            "voxels_with_more",
        ] {
            assert_eq!(one[key], found[key], "{key} of {}", one["grid"]);
        }
        let buffers = one["buffers"].as_object().unwrap().values().map(number);
        assert_eq!(number(&one["bytes"]), buffers.sum::<u64>());
        // What slices tell adds up to what the whole grid tells.
        let slices = found["slices"].as_array().unwrap();
        let sum = |key: &str| -> u64 {
            let name = one["grid"].as_str().unwrap();
            slices.iter().map(|slice| number(&slice[key][name])).sum()
        };
        assert_eq!(sum("voxels_allocated"), number(&one["voxels_allocated"]));
        assert!(sum("bytes") <= number(&one["bytes"]));
    }
    let [uniform, sliced, rows] = [0, 1, 2].map(|i| number(&per_grid[i]["voxels_allocated"]));
    assert_eq!(uniform, number(&found["voxels_domain"]));
    assert!(uniform > sliced && sliced >= rows && rows >= number(&found["voxels_occupied"]));
    assert_eq!(found["octree"]["leaves"], found["voxels_occupied"]);
    let memory: Vec<_> = found["memory"].as_array().unwrap().iter().collect();
    let named = |part: &str| {
        memory
            .iter()
            .filter(|one| one["name"].as_str().unwrap().contains(part))
            .count()
    };
    assert_eq!(
        (
            named("uniform-counting"),
            named("quadtree, leaves"),
            named("hash table")
        ),
        (1, 4, 2)
    );
    let over_time = found["over_time"].as_array().unwrap();
    assert_eq!(over_time.len(), 2);
    assert_eq!(over_time[1]["voxels_allocated"]["sliced-pool"], sliced);

    assert!(failure(&["inspect", "column_2d", "--grid", "sliced-pol"], 2).contains("there is counting"));
    let twice = ["inspect", "column_2d", "--grid", "sliced-pool", "sliced-pool"];
    assert!(failure(&twice, 2).contains("twice"));
}

#[test]
fn inspect_writes_a_folder_and_overwrites_only_with_force() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("deep/found");
    let out = out.to_str().unwrap();
    let args = [
        "inspect",
        "column_2d",
        "--frame",
        "1",
        "--every",
        "1",
        "--size",
        "320x240",
        "--grid",
        "sliced-pool",
        "rows-counting",
        "--out",
        out,
    ];
    let text = output(&args);
    assert!(
        text.contains("quadtree") && text.contains("sliced-pool"),
        "{text}"
    );
    let names: Vec<_> = files(Path::new(out)).into_keys().collect();
    assert_eq!(
        names,
        [
            "heatmap_rows-counting.png",
            "heatmap_sliced-pool.png",
            "occupancy.json",
            "occupancy.md",
            "over_time.png",
            "slice_profile.png",
            "slices.png",
        ]
    );
    let page = std::fs::read_to_string(Path::new(out).join("occupancy.md")).unwrap();
    assert!(page.contains("| slice |") && page.contains("|---|"), "{page}");
    assert_eq!(read_json(&Path::new(out).join("occupancy.json"))["frame"], 1);

    let before = files(Path::new(out));
    let message = failure(&args, 2);
    assert!(
        message.contains("occupancy.json") && message.contains("--force"),
        "{message}"
    );
    assert!(files(Path::new(out)) == before);
    let mut forced = args.to_vec();
    forced.push("--force");
    forced[3] = "0";
    output(&forced);
    assert_eq!(read_json(&Path::new(out).join("occupancy.json"))["frame"], 0);
}

#[test]
fn inspect_reads_particle_files() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cloud.csv");
    // Two clouds of eight points, far from zero and from each other.
    let mut text = String::from("x,y,z\n");
    for corner in 0..16 {
        let [x, y, z] = [0, 1, 2].map(|bit| f64::from(corner >> bit & 1) * 0.25);
        let far = f64::from(corner / 8) * 10.5;
        text += &format!("{},{},{}\n", 1e6 + x + far, y + far, z + far);
    }
    std::fs::write(&path, text).unwrap();
    let cloud = path.to_str().unwrap();
    let found = json(&[
        "inspect",
        cloud,
        "--radius",
        "1",
        "--grid",
        "sliced-pool",
        "--json",
    ]);
    assert_eq!(
        (&found["scene"], &found["particles"]),
        (&"cloud".into(), &16.into())
    );
    assert_eq!(
        (&found["voxels_occupied"], &found["voxels_with_more"]),
        (&2.into(), &2.into())
    );
    assert_eq!(found["grids"][0]["voxels_allocated"], 2);
    assert_eq!(found["grids"][0]["overflow"], 8);
    assert_eq!(found["time_s"], Value::Null);

    assert!(failure(&["inspect", cloud], 2).contains("--radius"));
    assert!(failure(&["inspect", cloud, "--radius", "1", "--frame", "3"], 2).contains("--frame"));
    assert!(failure(&["inspect", "column_2d", "--radius", "1"], 2).contains("particle files"));
}

/// Every file of a run but the manifest (which has times of day), by name.
fn files(folder: &Path) -> std::collections::BTreeMap<String, Vec<u8>> {
    let mut found = std::collections::BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(inside) = folders.pop() {
        for entry in std::fs::read_dir(inside).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if !path.ends_with("run.json") {
                let name = path.strip_prefix(folder).expect("inside").display().to_string();
                found.insert(name, std::fs::read(path).expect("a file"));
            }
        }
    }
    found
}

#[test]
fn two_runs_write_the_same_bytes() {
    let temporary = tempfile::tempdir().expect("a folder");
    let out = |name: &str| temporary.path().join(name).display().to_string();
    for name in ["one", "two"] {
        let out = out(name);
        let arguments = [
            "run",
            "harada_figure_2_small",
            "--out",
            &out,
            "--frames",
            "4",
            "--size",
            "320x180",
            "--particles",
            "npy",
            "--view",
            "both",
            "--progress",
            "plain",
        ];
        sliceflow(&arguments).args(ONE_CHECKPOINT).assert().success();
    }
    let (one, two) = (files(Path::new(&out("one"))), files(Path::new(&out("two"))));
    assert_eq!(one.len(), 4 + 4 * 6 + 2, "{:?}", one.keys());
    assert_eq!(one.keys().collect::<Vec<_>>(), two.keys().collect::<Vec<_>>());
    for (name, bytes) in &one {
        assert!(bytes == &two[name], "{name} differs");
    }
}

#[test]
fn every_scene_that_ships_runs_without_a_warning() {
    let temporary = tempfile::tempdir().expect("a folder");
    let listed = output(&["scenes"]);
    let scenes =
        std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/scenes")).expect("scenes");
    for scene in scenes {
        let path = scene.expect("an entry").path();
        let name = path.file_stem().expect("a name").to_str().expect("text");
        assert!(listed.contains(name), "{name} is not listed:\n{listed}");
        let out = temporary.path().join(name).display().to_string();
        // The second frame is near the first one: a few steps are as many as a warning needs.
        let text = std::fs::read_to_string(&path).expect("a scene");
        let scene: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        let fps = 8.0 * scene["time"]["fps"].as_f64().expect("a rate");
        let arguments = [
            "run",
            name,
            "--out",
            &out,
            "--frames",
            "2",
            "--fps",
            &fps.to_string(),
            "--size",
            "160x90",
            "--progress",
            "plain",
        ];
        let run = sliceflow(&arguments).assert().success();
        let told = String::from_utf8_lossy(&run.get_output().stderr).into_owned();
        let warnings: Vec<_> = told
            .lines()
            .filter(|l| l.starts_with("warning") && !l.contains("software"))
            .collect();
        assert!(warnings.is_empty(), "{name}: {warnings:?}");
    }
}
