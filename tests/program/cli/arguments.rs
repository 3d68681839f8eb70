//! Help, lists, and arguments that make no sense.

use super::{failure, json, output, sliceflow};

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
