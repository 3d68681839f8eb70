//! How many particles there are means one thing everywhere: those that move freely. Boundary particles are counted apart.

use std::fs;
use std::path::Path;

use assert_cmd::cargo_bin_cmd;
use serde_json::Value;

/// Four hundred particles of water.
const DAM: &str = r#"{
  "dimensions": 2,
  "domain": { "min": [0, 0], "max": [1, 1] },
  "fluid": { "solver": "wcsph", "spacing": 0.025, "viscosity": 0.05, "artificial_viscosity": 0.05 },
  "bodies": [ { "shape": { "kind": "box", "min": [0, 0], "max": [0.5, 0.5] } } ],
  "time": { "duration": 0.004, "fps": 500 },
  "render": { "size": [64, 48] }
}"#;

fn output(folder: &Path, args: &[&str]) -> String {
    let assert = cargo_bin_cmd!("sliceflow")
        .current_dir(folder)
        .args(args)
        .assert()
        .success();
    String::from_utf8(assert.get_output().stdout.clone()).unwrap()
}

fn json(folder: &Path, args: &[&str]) -> Value {
    serde_json::from_str(&output(folder, args)).unwrap()
}

fn counts(value: &Value) -> [u64; 2] {
    ["particles", "boundary_particles"]
        .map(|key| value[key].as_u64().unwrap_or_else(|| panic!("{key}: {value}")))
}

#[test]
fn boundary_particles_are_counted_apart_everywhere() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("dam.json"), DAM).unwrap();
    let plan = json(folder, &["plan", "dam.json", "--json"]);
    let [particles, boundary] = counts(&plan);
    assert_eq!(particles, 400);
    assert!(boundary > 300, "{boundary}");
    assert_eq!(plan["particles_at_start"], 400);
    assert_eq!(counts(&plan["plan"]), [400, boundary]);
    assert_eq!(plan["plan"]["capacity"], 400 + boundary);
    assert!(
        output(folder, &["plan", "dam.json"])
            .contains(&format!("particles  400, and {boundary} boundary particles"))
    );

    let run = ["run", "dam.json", "-o", "files", "-q", "--particles", "npy"];
    output(folder, &run);
    let manifest: Value = serde_json::from_slice(&fs::read(folder.join("files/run.json")).unwrap()).unwrap();
    assert_eq!(counts(&manifest), [400, boundary]);
    let statistics = fs::read_to_string(folder.join("files/stats.jsonl")).unwrap();
    assert_eq!(statistics.lines().count(), 3);
    for line in statistics.lines() {
        assert_eq!(counts(&serde_json::from_str(line).unwrap()), [400, boundary]);
    }

    // A checkpoint holds boundary particles, which a comparison with particle files leaves out.
    let run = [
        "run",
        "dam.json",
        "-o",
        "states",
        "-q",
        "--checkpoint-every",
        "1",
        "--keep-checkpoints",
        "9",
    ];
    output(folder, &run);
    let same = output(folder, &["diff", "files", "states"]);
    assert!(same.contains("particles: equal in 2 frames"), "{same}");

    let found = json(folder, &["inspect", "dam.json", "--every", "1", "--json", "-q"]);
    assert_eq!(counts(&found), [400, boundary]);
    let slices = found["slices"].as_array().unwrap().iter().map(counts);
    let sum = slices.fold([0, 0], |sum, one| [sum[0] + one[0], sum[1] + one[1]]);
    assert_eq!(sum, [400, boundary]);
    let over_time = found["over_time"].as_array().unwrap();
    assert!(over_time.iter().all(|sample| counts(sample) == [400, boundary]));
    // Voxels hold both.
    assert_eq!(
        over_time.last().unwrap()["voxels_occupied"],
        found["voxels_occupied"]
    );
}

#[test]
fn tables_of_inspect_are_csv() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("dam.json"), DAM).unwrap();
    let rows = |more: &[&str]| -> Vec<Vec<String>> {
        let text = output(folder, &[&["inspect", "dam.json", "-q", "--csv"], more].concat());
        // No cell of these tables has a comma but the structures' names, which are quoted.
        let cells = |line: &str| -> Vec<String> {
            let parts = line.split('"').enumerate();
            let plain = parts.map(|(number, part)| {
                if number % 2 == 1 {
                    part.replace(',', ";")
                } else {
                    part.to_owned()
                }
            });
            plain.collect::<String>().split(',').map(str::to_owned).collect()
        };
        text.lines().map(cells).collect()
    };
    let memory = rows(&["--grid", "uniform-counting", "sliced-counting"]);
    assert_eq!(memory[0][..2], ["name", "cells"]);
    let json = json(
        folder,
        &[
            "inspect",
            "dam.json",
            "-q",
            "--json",
            "--grid",
            "uniform-counting",
            "sliced-counting",
        ],
    );
    let expected = json["memory"].as_array().unwrap();
    assert_eq!(memory.len(), expected.len() + 1);
    let bytes = memory[0].iter().position(|head| head == "bytes").unwrap();
    for (row, one) in memory[1..].iter().zip(expected) {
        assert_eq!(row.len(), memory[0].len());
        assert_eq!(row[bytes], one["bytes"].to_string());
    }
    let over_time = rows(&["--every", "1"]);
    assert_eq!(over_time.len(), 1 + 3);
    assert!(
        over_time[0].contains(&"voxels_allocated.sliced-counting".to_owned()),
        "{:?}",
        over_time[0]
    );
    assert_eq!(rows(&["--slices"])[0][0], "slice");
    for both in [&["--every", "1", "--slices"][..], &["--json"]] {
        let mut command = cargo_bin_cmd!("sliceflow");
        command
            .current_dir(folder)
            .args(["inspect", "dam.json", "--csv"])
            .args(both);
        command.assert().code(2);
    }
}
