//! Studies write a page, its pictures and the same figures as JSON. Times are not asserted.

#![cfg(feature = "study")]

use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;

fn study(paper: &str, folder: &Path) -> Command {
    let mut command = Command::cargo_bin("sliceflow").expect("the program is built");
    command
        .args(["study", paper, "--scale", "tiny", "--out"])
        .arg(folder);
    command
}

/// The page's text and its JSON, after the study ran.
fn run(paper: &str, folder: &Path) -> (String, Value) {
    run_cases(paper, &[], folder)
}

fn run_cases(paper: &str, cases: &[&str], folder: &Path) -> (String, Value) {
    let mut command = study(paper, folder);
    command.args(cases.iter().flat_map(|&case| ["--case", case]));
    let output = command.output().expect("it starts");
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{told}");
    let page = folder.join(format!("{paper}.md"));
    let said = String::from_utf8_lossy(&output.stdout);
    assert_eq!(said.trim(), page.display().to_string());
    let json = std::fs::read_to_string(folder.join(format!("{paper}.json"))).expect("JSON");
    (
        std::fs::read_to_string(page).expect("a page"),
        serde_json::from_str(&json).expect("valid JSON"),
    )
}

/// Cells of a row of a Markdown table.
fn cells(line: &str) -> Vec<String> {
    let inside = line.trim_start_matches("| ").trim_end_matches(" |");
    inside
        .replace("\\|", "\u{1}")
        .split(" | ")
        .map(|cell| cell.replace('\u{1}', "|"))
        .collect()
}

/// Whether a cell shows a JSON value.
fn agrees(cell: &str, value: &Value) -> bool {
    match value {
        Value::Null => cell == "–",
        Value::String(text) => cell == text.replace('\n', " "),
        Value::Number(number) => {
            let number = number.as_f64().expect("finite");
            let (digits, unit) = cell.split_once(' ').unwrap_or((cell, ""));
            let factor = match unit {
                "" | "B" => 1.0,
                "KiB" => 1024.0,
                "MiB" => 1024.0 * 1024.0,
                "GiB" => 1024.0 * 1024.0 * 1024.0,
                other => panic!("unit `{other}` of `{cell}`"),
            };
            let shown: f64 = digits.replace(',', "").parse().expect(cell);
            (shown * factor - number).abs() <= 0.06 * number.abs().max(factor.min(1e-5))
        }
        other => panic!("{other}"),
    }
}

/// Every table of the JSON stands in the page with the same figures, and every picture exists; there are so many at least.
fn check(folder: &Path, page: &str, json: &Value, [least_tables, least_pictures]: [usize; 2]) {
    let lines: Vec<&str> = page.lines().collect();
    let mut tables = 0;
    for (key, rows) in json.as_object().expect("an object") {
        let Some(rows) = rows
            .as_array()
            .filter(|rows| rows.first().is_some_and(Value::is_object))
        else {
            continue;
        };
        tables += 1;
        let heads: Vec<&str> = rows[0]
            .as_object()
            .expect("a row")
            .keys()
            .map(String::as_str)
            .collect();
        let head = format!("| {} |", heads.join(" | "));
        let found = lines.iter().enumerate().filter(|(_, line)| **line == head);
        let same = found.into_iter().any(|(at, _)| {
            rows.iter().zip(&lines[at + 2..]).all(|(row, line)| {
                let values = row.as_object().expect("a row").values();
                let cells = cells(line);
                cells.len() == values.len()
                    && cells.iter().zip(values).all(|(cell, value)| agrees(cell, value))
            })
        });
        assert!(same, "table `{key}` differs from the page");
    }
    assert!(tables >= least_tables, "{tables} tables");
    let mut pictures = 0;
    for link in page.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
        let (width, height) = image::image_dimensions(folder.join(link)).expect(link);
        assert!(width > 100 && height > 100, "{link}");
        pictures += 1;
    }
    assert!(pictures >= least_pictures, "{pictures} pictures");
}

#[test]
fn green_has_a_page_with_the_same_figures_as_its_json() {
    let folder = tempfile::tempdir().expect("a folder");
    let (page, json) = run("green", folder.path());
    check(folder.path(), &page, &json, [3, 2]);
    // The paper's figures stand beside ours.
    let rates: Vec<f64> = json["frames_per_second"]
        .as_array()
        .expect("rates")
        .iter()
        .filter_map(|row| row["frames per second"].as_f64())
        .collect();
    assert_eq!(rates[..2], [175.0, 460.0]);
    assert!(
        rates.len() > 3 && rates.iter().all(|&rate| rate > 0.0),
        "{rates:?}"
    );

    let again = study("green", folder.path()).output().expect("it starts");
    assert_eq!(again.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&again.stderr).contains("--force"));
}

#[test]
fn harada_has_a_page_with_the_same_figures_as_its_json() {
    let folder = tempfile::tempdir().expect("a folder");
    let (page, json) = run("harada", folder.path());
    check(folder.path(), &page, &json, [3, 2]);
    let ratios: Vec<f64> = json["table_1"]
        .as_array()
        .expect("rows")
        .iter()
        .map(|row| row["paper"].as_f64().expect("a ratio"))
        .collect();
    assert_eq!(ratios, [0.0394, 0.0619, 0.269, 0.488]);
    // The octree never has more leaves than a grid has voxels, except where a grid's voxels are leaves too.
    for row in json["figure_6"].as_array().expect("rows") {
        let leaves = row["octree's leaves"].as_f64().expect("leaves");
        for (grid, voxels) in row.as_object().expect("a row").iter().skip(2) {
            assert!(voxels.as_f64().expect("voxels") >= leaves, "{grid}: {row}");
        }
    }
    // Four dams with three grids each, and 256³ voxels of 16 bytes.
    let fluids = json["table_3"].as_array().expect("rows");
    assert_eq!(fluids.len(), 4);
    assert!(
        fluids
            .iter()
            .all(|row| row["ratio"].as_f64().is_some_and(|ratio| ratio > 0.0)),
        "{fluids:?}"
    );
    let memory = json["table_3_memory"].as_array().expect("rows");
    let uniform = memory
        .iter()
        .find(|row| row["256³ voxels"] == "`uniform`")
        .expect("uniform");
    let share = uniform["dam"].as_f64().expect("bytes") / 268_435_456.0;
    assert!((0.99..1.03).contains(&share), "{share}");
    // The paper's area, smaller by 16 along each side.
    let large = json["figure_8_memory"].as_array().expect("rows");
    let bytes = |name: &str| {
        let row = large.iter().find(|row| row["addressing"] == name).expect(name);
        row["four indices per voxel"].as_f64().expect("bytes")
    };
    assert_eq!(bytes("`uniform`"), 43.0 * 43.0 * 16.0 * 16.0);
    assert!(bytes("`sliced`") < bytes("`uniform`") / 4.0);
}

#[test]
fn accuracy_is_judged_and_drawn() {
    let folder = tempfile::tempdir().expect("a folder");
    let (page, json) = run_cases("accuracy", &["collision", "gas"], folder.path());
    let records = json["records"].as_array().expect("records");
    let value = |case: &str, integrator: &str, resolution: u32, figure: &str| {
        let of_run = |record: &&Value| {
            record["case"] == case
                && record["method"]["integrator"] == integrator
                && record["resolution"] == resolution
        };
        let record = records.iter().find(of_run).expect("the run");
        assert!(record["wall"].as_f64().expect("seconds") > 0.0);
        let updates =
            record["particles"].as_u64().expect("a count") * record["steps"].as_u64().expect("a count");
        assert_eq!(record["particle_updates"], updates);
        let figures = record["figures"].as_array().expect("figures");
        let found = figures.iter().find(|row| row["name"] == figure).expect(figure);
        found["value"].as_f64().expect("a number")
    };
    for integrator in ["symplectic_euler", "velocity_verlet"] {
        let [coarse, fine] = [20, 50].map(|steps| value("collision", integrator, steps, "worst error of e"));
        assert!(
            fine < 0.6 * coarse && fine < 0.015,
            "{integrator}: {coarse} {fine}"
        );
        let [coarse, fine] = [20, 50].map(|steps| value("gas", integrator, steps, "energy drift"));
        assert!(
            fine < 0.5 * coarse && coarse < 1e-3,
            "{integrator}: {coarse} {fine}"
        );
    }
    assert!(page.contains("| LIGGGHTS (f64) | ≤ 0.001 |"), "{page}");
    for case in ["collision", "gas"] {
        for diagram in ["time", "updates", "resolution"] {
            let png = format!("{case}_{diagram}.png");
            assert!(page.contains(&format!("]({png})")), "{png}");
            image::image_dimensions(folder.path().join(&png)).expect(&png);
            let svg = std::fs::read_to_string(folder.path().join(format!("{case}_{diagram}.svg")));
            assert!(
                svg.expect("an SVG").contains("velocity_verlet"),
                "{case} {diagram}"
            );
        }
    }
}

/// The first figure of each fluid's run: an error in percent.
#[test]
fn fluids_follow_theory() {
    let folder = tempfile::tempdir().expect("a folder");
    let cases = ["taylor_green_2d", "poiseuille", "couette"];
    let (_, json) = run_cases("accuracy", &cases, folder.path());
    let records = json["records"].as_array().expect("records");
    let error = |case: &str, what: &str| {
        let of_run = |record: &&Value| {
            record["case"] == case && (what.is_empty() || record["method"].to_string().contains(what))
        };
        let record = records.iter().find(of_run).expect("the run");
        record["figures"][0]["value"].as_f64().expect("a number")
    };
    // 25 particles across: PySPH's best is 2.75 %, and 59 % without shifting.
    let shifted = error("taylor_green_2d", "shifting");
    assert!(shifted < 0.8, "{shifted} %");
    // Were the plain solver as good, the two would be one.
    let plain = error("taylor_green_2d", "summation");
    assert!(plain > 10.0 && plain < 100.0, "{plain} %");
    for case in ["poiseuille", "couette"] {
        let found = error(case, "walls of particles");
        assert!(found < 0.5, "{case}: {found} %");
    }
}

#[test]
fn cases_are_chosen_by_name_and_resolution() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut chosen = study("accuracy", folder.path());
    chosen.args(["--case", "collision", "--resolution", "30"]);
    chosen.assert().success();
    let json = std::fs::read_to_string(folder.path().join("accuracy.json")).expect("JSON");
    let json: Value = serde_json::from_str(&json).expect("valid JSON");
    let records = json["records"].as_array().expect("records");
    assert_eq!(records.len(), 2);
    assert!(records.iter().all(|record| record["resolution"] == 30));

    for (subject, more, told) in [
        ("accuracy", ["--case", "colission"], "did you mean `collision`?"),
        ("harada", ["--resolution", "3"], "no resolutions"),
        ("harada", ["--case", "table_9"], "figure_6"),
    ] {
        let output = study(subject, &folder.path().join("other"))
            .args(more)
            .output()
            .expect("it starts");
        assert_eq!(output.status.code(), Some(2));
        assert!(String::from_utf8_lossy(&output.stderr).contains(told));
    }
}

/// Every study has parts that run alone, which the help names.
#[test]
fn a_part_runs_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    let (page, json) = run_cases("green", &["frames_per_second"], folder.path());
    assert!(json["frames_per_second"].is_array(), "{json}");
    for other in ["ways", "deterministic", "missing"] {
        assert_eq!(json[other], Value::Null, "{other}");
    }
    assert!(
        page.contains("## Frames per second") && !page.contains("## What repeatable"),
        "{page}"
    );

    let help = Command::cargo_bin("sliceflow")
        .expect("the program is built")
        .args(["study", "--help"])
        .output();
    let help = String::from_utf8_lossy(&help.expect("it starts").stdout).into_owned();
    for case in ["table_1", "ways", "taylor_green_2d", "figure_10", "hard_cases"] {
        assert!(help.contains(case), "{case}: {help}");
    }
}

#[test]
fn rojas_has_a_page_with_the_same_figures_as_its_json() {
    let folder = tempfile::tempdir().expect("a folder");
    let (page, json) = run("rojas", folder.path());
    check(folder.path(), &page, &json, [2, 2]);
    let rows = json["figure_10"].as_array().expect("rows");
    // Three ways, 64 and 256 particles each.
    let particles: Vec<f64> = rows.iter().filter_map(|row| row["particles"].as_f64()).collect();
    assert_eq!(particles, [64.0, 256.0, 64.0, 256.0, 64.0, 256.0]);
    for row in rows {
        assert!(
            row["real-time ratio"].as_f64().is_some_and(|ratio| ratio > 0.0),
            "{row}"
        );
        assert_eq!(row["remark"], Value::Null, "{row}");
    }
    // The step follows the spacing.
    let step = |row: usize| rows[row]["time step, µs"].as_f64().expect("a step");
    assert!(
        (1.7..2.3).contains(&(step(0) / step(1))),
        "{} {}",
        step(0),
        step(1)
    );
}

#[test]
fn stable_steps_stand_beside_theory() {
    let folder = tempfile::tempdir().expect("a folder");
    let (page, json) = run_cases("stability", &["steps"], folder.path());
    check(folder.path(), &page, &json, [1, 1]);
    // Linear theory tells how long steps of sound on a lattice and of a column of grains may be.
    let rows = json["steps"].as_array().expect("rows");
    let mut told = 0;
    for row in rows {
        let [stable, unstable, theory] = ["longest stable, µs", "shortest unstable, µs", "theory, µs"]
            .map(|key| row[key].as_f64().unwrap_or(f64::NAN));
        if theory.is_finite() {
            told += 1;
            assert!(stable < 1.25 * theory && unstable > 0.8 * theory, "{row}");
        }
        // What scenes take by themselves is stable.
        assert!(
            row["stable over own"].as_f64().is_some_and(|ratio| ratio >= 1.0),
            "{row}"
        );
    }
    assert_eq!((rows.len(), told), (8, 5));
}

#[test]
fn every_case_that_does_not_hold_is_listed() {
    let folder = tempfile::tempdir().expect("a folder");
    let (page, json) = run_cases("stability", &["rests", "hard_cases"], folder.path());
    check(folder.path(), &page, &json, [2, 1]);
    for (begins, list) in [("fails", "failing"), ("stopped", "stopped")] {
        let bad = |key: &str| {
            let rows = json[key].as_array().expect("rows");
            let columns = ["verdict", "fixed steps", "adaptive steps"];
            let verdicts = rows
                .iter()
                .flat_map(|row| columns.iter().filter_map(|&column| row[column].as_str()));
            verdicts.filter(|verdict| verdict.starts_with(begins)).count()
        };
        assert_eq!(
            json[list].as_array().map(Vec::len),
            Some(bad("rests") + bad("hard")),
            "{list}"
        );
    }
}

#[test]
fn what_guards_cost_has_a_page_with_the_same_figures_as_its_json() {
    let folder = tempfile::tempdir().expect("a folder");
    let (page, json) = run_cases("stability", &["guards"], folder.path());
    check(folder.path(), &page, &json, [1, 0]);
}

#[test]
fn speed_is_weighed_against_error() {
    let folder = tempfile::tempdir().expect("a folder");
    let (page, json) = run_cases("speed-error", &["poiseuille", "still_water"], folder.path());
    let mut tables = json.clone();
    tables.as_object_mut().expect("an object").remove("rungs");
    check(folder.path(), &page, &tables, [4, 2]);
    let rungs = json["rungs"].as_array().expect("rungs");
    for solver in ["wcsph", "dfsph"] {
        let found = rungs.iter().filter(|rung| rung["name"] == solver);
        assert_eq!(found.count(), 2, "{solver}: {rungs:?}");
    }
    // No row of the front is beaten by another in time and error.
    for case in ["still_water", "poiseuille"] {
        let rows = json[case].as_array().expect("rows");
        let value = |row: &Value, key: &str| row[key].as_f64();
        let (time, error) = ("wall s per simulated s", "error, %");
        let front: Vec<&Value> = rows.iter().filter(|row| row["front"] == "yes").collect();
        assert!(!front.is_empty(), "{rows:?}");
        for row in rows.iter().filter(|row| row["remark"].is_null()) {
            for best in &front {
                let beaten = value(row, time) < value(best, time) && value(row, error) < value(best, error);
                assert!(!beaten, "{row} beats {best}");
            }
        }
        assert!(folder.path().join(format!("speed-error_{case}.svg")).exists());
    }
    assert!(!page.contains("SPlisHSPlasH was not measured"), "{page}");

    // `plan` takes what was measured.
    let results = folder.path().join("achieved.json");
    let achieved: Value =
        serde_json::from_str(&std::fs::read_to_string(&results).expect("results")).expect("JSON");
    let worst = achieved["rungs"].as_array().expect("rungs").iter();
    let worst = worst
        .filter(|rung| rung["case"] == "still_water")
        .filter_map(|rung| rung["error"].as_f64());
    let asked = format!("{}%", worst.fold(0.0, f64::max) + 1.0);
    let plan = |error: &str| {
        let mut command = Command::cargo_bin("sliceflow").expect("the program is built");
        command
            .args(["plan", "still_water", "--error", error, "--json", "--results"])
            .arg(&results);
        command
    };
    let assert = plan(&asked).assert().success();
    let proposal: Value = serde_json::from_slice(&assert.get_output().stdout).expect("JSON");
    assert_eq!(proposal["basis"]["like"], "still_water");
    assert!(proposal["proposal"]["step_s"].as_f64().expect("a step") > 0.0);
    let refused = plan("1e-9%").assert().code(2);
    let told = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
    assert!(told.contains("--error"), "{told}");
}

#[test]
fn grains_have_a_page_with_the_same_figures_as_its_json() {
    let folder = tempfile::tempdir().expect("a folder");
    let cases = ["restitution", "oblique", "heap", "hopper"];
    let (page, json) = run_cases("grains", &cases, folder.path());
    check(folder.path(), &page, &json, [6, 2]);
    for row in json["restitution"].as_array().expect("rows") {
        let error = row["largest error of e"].as_f64().expect("a number");
        let steps = row["steps per contact"].as_f64().expect("a number");
        assert!(steps < 50.0 || error <= 1e-3, "{row}");
    }
    let angles: Vec<f64> = json["heap"]
        .as_array()
        .expect("rows")
        .iter()
        .map(|row| row["angle, degrees"].as_f64().expect("a number"))
        .collect();
    assert!(angles[0] < angles[1], "friction makes heaps steeper: {angles:?}");
    // The bar is 0.15 at the study's usual size; this is a small bin.
    let exponent = &json["hopper_exponent"][0];
    let error = exponent["error"].as_f64().expect("a number");
    assert!(error.abs() < 0.3, "{exponent}");
}

#[test]
fn only_one_study_runs_other_programs() {
    let folder = tempfile::tempdir().expect("a folder");
    let refused = |paper: &str, python: &str| {
        let output = study(paper, folder.path())
            .args(["--peers", python])
            .output()
            .expect("it starts");
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    assert!(refused("green", "python3").contains("speed-error"));
    assert!(refused("speed-error", "/no/such/python").contains("/no/such/python"));
}
