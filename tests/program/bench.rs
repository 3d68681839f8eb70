//! `sliceflow bench` measures, writes and compares. No figure is asserted that depends on a machine's speed.

#![cfg(feature = "study")]

use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;

fn bench(args: &[&str], folder: &Path) -> Command {
    let mut command = Command::cargo_bin("sliceflow").expect("the program is built");
    command.current_dir(folder).arg("bench").args(args);
    command
}

fn told(command: &mut Command, code: i32) -> String {
    let assert = command.assert().code(code);
    let output = assert.get_output();
    let [out, err] =
        [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
    out + &err
}

const TINY: [&str; 2] = ["--size", "tiny"];

#[test]
fn every_scene_is_measured_and_can_be_compared() {
    let folder = tempfile::tempdir().expect("a folder");
    let args = [&TINY[..], &["--json", "a.json"]].concat();
    let text = told(&mut bench(&args, folder.path()), 0);
    let json = std::fs::read_to_string(folder.path().join("a.json")).expect("JSON");
    let report: Value = serde_json::from_str(&json).expect("valid JSON");
    assert!(
        text.contains(report["machine"]["adapter"].as_str().expect("a name")),
        "{text}"
    );
    assert_eq!(
        report["left_out"].as_array().expect("a list").len(),
        0,
        "{report}"
    );
    let number = |value: &Value| value.as_f64().unwrap_or_else(|| panic!("{value} in {report}"));
    assert!(number(&report["probes"]["copy_bytes_per_s"]) > 0.0);
    assert!(number(&report["probes"]["operations_per_s"]) > 0.0);
    let runs = report["runs"].as_array().expect("runs");
    assert_eq!(runs.len(), 7);
    for run in runs {
        let name = run["scene"].as_str().expect("a name");
        assert!(text.contains(name), "{text}");
        let [median, least, most] = ["median", "least", "most"].map(|key| number(&run["step_ms"][key]));
        assert!(0.0 < least && least <= median && median <= most, "{run}");
        let rate = number(&run["particle_steps_per_s"]);
        assert!((rate * median * 1e-3 / number(&run["particles"]) - 1.0).abs() < 1e-6);
        let pairs = number(&run["pairs_per_particle"]);
        assert!((number(&run["pairs_per_s"]) / (rate * pairs) - 1.0).abs() < 1e-6);
        // A kernel of water reaches at least its nearest neighbors, and a packed grain touches some.
        let least_pairs = match name {
            "grains_falling" => 0.5,
            "grains_2d" | "grains_settled" => 1.0,
            _ => 8.0,
        };
        assert!(pairs > least_pairs, "{name}: {pairs}");
        assert!(number(&run["copy_share"]) > 0.0 && number(&run["arithmetic_share"]) > 0.0);
        assert!(run["passes"].as_array().expect("passes").len() > 5, "{run}");
        assert!(number(&run["outputs"]["columns_ms"]) > 0.0);
    }
    let pictured = runs.iter().filter(|run| run["outputs"]["picture_ms"].is_f64());
    assert!(pictured.count() >= 2);

    // The file is kept unless it may be replaced.
    assert!(told(&mut bench(&args, folder.path()), 2).contains("--force"));

    let same = told(&mut bench(&["compare", "a.json", "a.json"], folder.path()), 0);
    assert_eq!(same.matches("within the spread").count(), 7, "{same}");

    // Twice as fast in every round is faster; what only one has is named.
    let mut faster = report.clone();
    let runs = faster["runs"].as_array_mut().expect("runs");
    runs.pop();
    for run in runs.iter_mut() {
        for key in ["median", "least", "most"] {
            run["step_ms"][key] = (number(&run["step_ms"][key]) / 1e3).into();
        }
    }
    std::fs::write(folder.path().join("b.json"), faster.to_string()).expect("a file");
    let compared = told(&mut bench(&["compare", "a.json", "b.json"], folder.path()), 0);
    assert_eq!(compared.matches("faster").count(), 6, "{compared}");
    assert!(
        compared.contains("× 1000.00") && compared.contains("only in before: grains_2d"),
        "{compared}"
    );
    let compared = told(&mut bench(&["compare", "b.json", "a.json"], folder.path()), 0);
    assert_eq!(compared.matches("slower").count(), 6, "{compared}");
}

#[test]
fn bad_input_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let refused = |args: &[&str], code| told(&mut bench(args, folder.path()), code);
    assert!(refused(&["--scene", "fire"], 2).contains("grains_settled"));
    assert!(refused(&["--size", "enormous"], 2).contains("quick"));
    assert!(refused(&["--force"], 2).contains("--json"));
    assert!(refused(&["compare", "a.json"], 2).contains("AFTER"));
    assert!(refused(&["compare", "a.json", "b.json"], 1).contains("a.json"));
    std::fs::write(folder.path().join("a.json"), "{}").expect("a file");
    assert!(refused(&["compare", "a.json", "a.json"], 1).contains("bench --json"));
    let nowhere = [&TINY[..], &["--json", "no/such/folder/a.json"]].concat();
    assert!(refused(&nowhere, 1).contains("no/such/folder"));
}
