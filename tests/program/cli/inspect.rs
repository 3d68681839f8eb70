//! `inspect`.

use std::path::Path;

use serde_json::Value;

use super::{failure, files, json, output, read_json};

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
