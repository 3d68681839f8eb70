//! Recordings for the Rerun viewer, read back with Rerun's own decoder.
#![cfg(feature = "rerun")]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::BufReader;
use std::path::Path;

use rerun::external::re_log_encoding::DecoderApp;
use rerun::log::{Chunk, LogMsg};

use crate::command::sliceflow;

/// A short run of small frames in `folder`.
fn short_run<'a>(scene: &'a str, out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let mut args = vec![
        "run", scene, "--out", out, "--frames", "6", "--fps", "500", "--size", "160x120",
    ];
    args.extend(more);
    args
}

/// What stands in a recording.
#[derive(Default)]
struct Recording {
    /// Rows by entity.
    rows: BTreeMap<String, usize>,
    timelines: BTreeSet<String>,
    components: BTreeSet<String>,
    /// Entities of the blueprint.
    blueprint: BTreeSet<String>,
    activated: bool,
    /// Particles of each row of positions.
    particles: Vec<usize>,
}

fn read(path: &Path) -> Recording {
    let mut found = Recording::default();
    let file = BufReader::new(fs::File::open(path).expect("a recording"));
    for message in DecoderApp::decode_eager(file).expect("a header") {
        match message.expect("a message that decodes") {
            LogMsg::ArrowMsg(store, message) => {
                let chunk = Chunk::from_arrow_msg(&message).expect("a chunk");
                let entity = chunk.entity_path().to_string();
                if store.kind() == rerun::StoreKind::Blueprint {
                    found.blueprint.insert(entity);
                    continue;
                }
                *found.rows.entry(entity.clone()).or_default() += chunk.num_rows();
                found
                    .timelines
                    .extend(chunk.timelines().keys().map(|name| name.to_string()));
                for column in chunk.components().values() {
                    let name = column.descriptor.component.to_string();
                    if name == "Points3D:positions" {
                        let arrays = column.list_array.iter();
                        found.particles.extend(arrays.flatten().map(|array| array.len()));
                    }
                    found.components.insert(name);
                }
            }
            LogMsg::BlueprintActivationCommand(command) => found.activated = command.make_active,
            LogMsg::SetStoreInfo(_) => {}
        }
    }
    found
}

/// Whether the file ends as Rerun's files do: with a footer that its encoder writes last.
fn has_footer(path: &Path) -> bool {
    let bytes = fs::read(path).expect("a recording");
    bytes[bytes.len() - 64..].windows(4).any(|four| four == b"FOOT")
}

#[test]
fn a_recording_has_everything_and_a_layout() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out").display().to_string();
    // A folder that is missing is made.
    let file = folder.path().join("deep/run.rrd");
    let name = file.display().to_string();
    let more = [
        "--rerun",
        &name,
        "--progress",
        "plain",
        "--timings",
        "--grid",
        "sliced-pool",
    ];
    let run = sliceflow(&short_run("green_cube", &out, &more))
        .assert()
        .success();
    let told = String::from_utf8_lossy(&run.get_output().stderr).into_owned();
    assert!(told.contains("Rerun gets all"), "{told}");

    let found = read(&file);
    assert!(has_footer(&file));
    let manifest = fs::read_to_string(folder.path().join("out/run.json")).unwrap();
    assert!(manifest.contains(&format!("\"name\": \"{name}\"")), "{manifest}");
    for (entity, rows) in [
        ("/scene/particles", 1 + 6),
        ("/scene/allocated", 6),
        ("/scene/camera", 2 + 6),
        ("/index_pool", 1 + 6),
        ("/occupancy", 6),
        ("/statistics/energy", 1 + 6),
        ("/statistics/contacts", 1 + 6),
        ("/statistics/overflow", 1 + 6),
        ("/statistics/time_step", 1 + 6),
        ("/statistics/throughput", 1 + 5),
        ("/scene/domain", 1),
        ("/documents/scene", 1),
        ("/documents/plan", 1),
        ("/documents/about", 1),
    ] {
        assert_eq!(found.rows.get(entity), Some(&rows), "{entity}: {:?}", found.rows);
    }
    assert!(found.rows["/statistics/passes"] >= 6, "{:?}", found.rows);
    assert!(found.rows.contains_key("/events"), "{:?}", found.rows);
    assert!(
        found
            .rows
            .keys()
            .any(|entity| entity.starts_with("/scene/colliders/")),
        "{:?}",
        found.rows
    );
    assert_eq!(found.timelines, ["frame", "sim_time"].map(str::to_owned).into());
    for component in [
        "Points3D:colors",
        "Points3D:radii",
        "Boxes3D:half_sizes",
        "Pinhole:image_from_camera",
        "EncodedImage:blob",
        "SegmentationImage:buffer",
        "BarChart:values",
        "SeriesLines:names",
        "TextDocument:text",
    ] {
        assert!(found.components.contains(component), "{:?}", found.components);
    }
    assert!(
        found.activated && found.blueprint.contains("/viewport"),
        "{:?}",
        found.blueprint
    );
    assert!(
        found
            .blueprint
            .iter()
            .any(|entity| entity.ends_with("EyeControls3D"))
    );
    assert!(found.particles.windows(2).all(|pair| pair[0] == pair[1]));
}

#[test]
fn particle_files_have_their_own_columns_only() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let file = folder.path().join("run.rrd").display().to_string();
    let more = [
        "--rerun",
        &file,
        "--particles",
        "npy",
        "--columns",
        "id",
        "--no-pictures",
    ];
    sliceflow(&short_run("column_2d", out.to_str().unwrap(), &more))
        .assert()
        .success();
    let written: Vec<_> = fs::read_dir(out.join("particles_000003"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    assert_eq!(written, ["id.npy"]);
    let found = read(&folder.path().join("run.rrd"));
    assert!(found.rows.contains_key("/scene/particles") && !found.rows.contains_key("/scene/camera"));
}

#[test]
fn a_budget_is_kept_and_told() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out").display().to_string();
    let file = folder.path().join("run.rrd");
    let name = file.display().to_string();
    let more = ["--rerun", &name, "--rerun-budget", "2MB", "--progress", "plain"];
    let run = sliceflow(&short_run("green_cube", &out, &more))
        .assert()
        .success();
    let told = String::from_utf8_lossy(&run.get_output().stderr).into_owned();
    assert!(
        told.contains(" of ") && told.contains("chosen at random"),
        "{told}"
    );
    assert!(fs::metadata(&file).unwrap().len() < 2_000_000);
    let found = read(&file);
    assert!(
        found
            .particles
            .iter()
            .all(|&n| n > 100 && n == found.particles[0]),
        "{:?}",
        found.particles
    );

    let too_small = ["--rerun", &name, "--force", "--rerun-budget", "10kB"];
    let failed = sliceflow(&short_run("green_cube", &out, &too_small))
        .assert()
        .code(2);
    let told = String::from_utf8_lossy(&failed.get_output().stderr).into_owned();
    assert!(told.contains("--rerun-budget"), "{told}");
}

#[test]
fn a_recording_is_replaced_only_with_force() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out").display().to_string();
    let file = folder.path().join("run.rrd");
    fs::write(&file, "mine").unwrap();
    let name = file.display().to_string();
    let run = short_run("column_2d", &out, &["--rerun", &name]);
    let refused = sliceflow(&run).assert().code(2);
    let told = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
    assert!(told.contains("run.rrd") && told.contains("--force"), "{told}");
    assert_eq!(fs::read_to_string(&file).unwrap(), "mine");
    assert!(!Path::new(&out).exists(), "refused before anything was written");

    sliceflow(&run).arg("--force").assert().success();
    assert!(has_footer(&file));
}

/// Runs against an address, and gives what was told.
fn run_with_viewer(address: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let more = ["--rerun-connect", address, "--progress", "plain"];
    let run = sliceflow(&short_run("column_2d", out.to_str().unwrap(), &more))
        .assert()
        .success();
    assert!(out.join("frame_000005.png").exists());
    String::from_utf8_lossy(&run.get_output().stderr).into_owned()
}

#[test]
fn a_viewer_that_is_not_there_is_warned_of_and_the_run_goes_on() {
    let closed = std::net::TcpListener::bind("127.0.0.1:0")
        .unwrap()
        .local_addr()
        .unwrap();
    let told = run_with_viewer(&closed.to_string());
    let warnings = told
        .lines()
        .filter(|l| l.starts_with("warning") && l.contains("viewer"));
    assert_eq!(warnings.count(), 1, "{told}");
}

#[test]
fn a_viewer_that_hangs_up_is_warned_of_once_and_the_run_goes_on() {
    warns_once_of_a_viewer(false);
}

#[test]
fn a_viewer_that_says_nothing_is_warned_of_once_and_the_run_goes_on() {
    warns_once_of_a_viewer(true);
}

/// Of one that closes every connection, or of one that keeps them and never answers.
fn warns_once_of_a_viewer(keep: bool) {
    let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap().to_string();
    std::thread::spawn(move || {
        let mut kept = Vec::new();
        for connection in listener.incoming() {
            if keep {
                kept.push(connection);
            }
        }
    });
    let told = run_with_viewer(&address);
    let warnings = told
        .lines()
        .filter(|l| l.starts_with("warning") && l.contains("lost"));
    assert_eq!(warnings.count(), 1, "{told}");
}

#[test]
fn what_cannot_be_a_target_is_told() {
    for (args, words) in [
        (&["--rerun", "session.mp4"][..], ".rrd"),
        (&["--rerun-connect", "somewhere"], "HOST:PORT"),
        (&["--rerun", "a.rrd", "--rerun-budget", "many"], "500MB"),
    ] {
        let failed = sliceflow(&short_run("column_2d", "out", args)).assert().code(2);
        let told = String::from_utf8_lossy(&failed.get_output().stderr).into_owned();
        assert!(told.contains(words), "{args:?}: {told}");
    }
}

#[test]
fn a_viewer_that_cannot_be_started_is_told_with_the_way_to_get_it() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let run = short_run("column_2d", out.to_str().unwrap(), &["--rerun-serve"]);
    // No program is in an empty PATH; ports that somebody has are told as such.
    let failed = sliceflow(&run).env("PATH", folder.path()).assert().code(2);
    let told = String::from_utf8_lossy(&failed.get_output().stderr).into_owned();
    assert!(
        told.contains("pip install rerun-sdk") || told.contains("is taken"),
        "{told}"
    );
}

#[test]
fn a_fluid_has_curves_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out").display().to_string();
    let file = folder.path().join("run.rrd");
    let name = file.display().to_string();
    let run = ["--rerun", &name, "--set", "fluid.spacing=0.05"];
    sliceflow(&short_run("dam_break_2d", &out, &run))
        .assert()
        .success();
    let found = read(&file);
    for entity in [
        "density",
        "clamped",
        "energy",
        "speed",
        "particles",
        "voxels",
        "time_step",
    ] {
        assert!(
            found.rows.contains_key(&format!("/statistics/{entity}")),
            "{entity}: {:?}",
            found.rows
        );
    }
    for of_grains in ["overlap", "contacts", "density_error_mean"] {
        assert!(
            !found.rows.contains_key(&format!("/statistics/{of_grains}")),
            "{of_grains}: {:?}",
            found.rows
        );
    }
    // Boundary particles are not shown.
    assert!(
        found.particles.iter().all(|&shown| shown == 100),
        "{:?}",
        found.particles
    );
}
