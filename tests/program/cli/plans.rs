//! `plan`.

use serde_json::Value;

use super::{json, output, sliceflow};

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
