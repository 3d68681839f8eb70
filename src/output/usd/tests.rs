use super::*;
use crate::scene::load::parse;

const TANK: &str = r##"{
    "domain": { "min": [10, 0, 0], "max": [12, 1, 1] },
    "fluid": { "spacing": 0.1 },
    "bodies": [{ "shape": { "kind": "box", "min": [10, 0, 0], "max": [10.5, 0.5, 0.5] } }],
    "time": { "duration": 1, "fps": 10 },
    "colliders": [
        { "name": "gate of iron", "color": "#ffffff",
          "shape": { "kind": "box", "min": [11, 0, 0], "max": [11.2, 1, 1] },
          "path": [{ "at": 0.5, "offset": [0, 0, 0] }, { "at": 1, "offset": [0, 0.5, 0] }] },
        { "shape": { "kind": "plane", "point": [10, 0.2, 0], "normal": [0, 1, 0] }, "visible": false }
    ]
}"##;

/// Two particles at frames 0 and 2, and a triangle at frame 0.
fn run(folder: &Path) {
    for frame in [0, 2] {
        let ply = format!(
            "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n\
             property float vx\nproperty float vy\nproperty float vz\nproperty uint id\nproperty float density\n\
             end_header\n10.5 0.25 {frame} 1 2 3 0 999\n11 0.5 0.5 4 5 6 1 1001\n"
        );
        std::fs::write(folder.join(format!("particles_{frame:06}.ply")), ply).unwrap();
    }
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
               element face 1\nproperty list uchar int vertex_indices\nend_header\n10 0 0\n11 0 0\n10 1 0\n3 0 1 2\n";
    std::fs::write(folder.join("surface_000000.ply"), ply).unwrap();
}

fn export(folder: &Path, one_file: bool, force: bool) -> Result<Exported> {
    let scene = parse(TANK, "tank", Path::new("."), &[]).unwrap();
    let export = Export {
        scene: &scene,
        run: folder,
        surfaces: folder,
        out: &folder.join("usd"),
        one_file,
        force,
    };
    export.write()
}

#[test]
fn one_file_holds_every_frame() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path());
    let exported = export(folder.path(), true, false).unwrap();
    assert_eq!((exported.particles, exported.surfaces), (2, 1));
    let text = std::fs::read_to_string(folder.path().join("usd").join(SCENE)).unwrap();
    // The origin is the middle of the domain.
    for expected in [
        "double3 xformOp:translate = (11, 0.5, 0.5)\n",
        "point3f[] points.timeSamples = {\n            0: [(-0.5, -0.25, -0.5), (0, 0, 0)],\n            2: [(-0.5, -0.25, 1.5), (0, 0, 0)],\n",
        "0: [(1, 2, 3), (4, 5, 6)],",
        "int64[] ids.timeSamples = {\n            0: [0, 1],",
        "float[] primvars:density (interpolation = \"vertex\")",
        "float[] widths (interpolation = \"constant\")",
        "0: [0, 1, 2],",
        "endTimeCode = 2\n    timeCodesPerSecond = 10\n",
        "def Cube \"gate_of_iron_0\"",
        "color3f[] primvars:displayColor = [(1, 1, 1)]",
        "token visibility = \"invisible\"",
    ] {
        assert!(text.contains(expected), "{expected}\n{text}");
    }
    // The gate moves from frame 5 to frame 10.
    let moves: Vec<_> = text
        .lines()
        .map(str::trim)
        .filter(|line| line.starts_with("5: (") || line.starts_with("10: ("))
        .collect();
    assert_eq!(moves.len(), 2, "{text}");
    assert!(moves[1].contains("0.5,"), "{moves:?}");
}

#[test]
fn clips_are_files_of_single_frames() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path());
    export(folder.path(), false, false).unwrap();
    let read = |name: &str| std::fs::read_to_string(folder.path().join("usd").join(name)).unwrap();
    let scene = read(SCENE);
    for expected in [
        "active = [(0, 0), (2, 1)]",
        "[@./particles_000000.usda@, @./particles_000002.usda@]",
        "times = [(0, 0), (2, 2)]",
        "primPath = \"/surface\"",
    ] {
        assert!(scene.contains(expected), "{expected}\n{scene}");
    }
    assert!(!scene.contains("points.timeSamples"), "values are in the clips");
    assert!(read("particles_000002.usda").contains("2: [(-0.5, -0.25, 1.5), (0, 0, 0)],"));
    let manifest = read("particles_manifest.usda");
    assert!(manifest.contains("float[] primvars:density") && !manifest.contains("timeSamples"));
}

#[test]
fn files_that_are_there_are_replaced_only_with_force_and_only_ours() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path());
    export(folder.path(), false, false).unwrap();
    let refused = |one_file, force| export(folder.path(), one_file, force).err().unwrap().to_string();
    assert!(refused(true, false).contains("--force"));
    export(folder.path(), true, true).unwrap();
    std::fs::write(folder.path().join("usd/particles_000002.usda"), "#usda 1.0\nmine").unwrap();
    assert!(refused(false, true).contains("no USD file that Sliceflow has written"));
    std::fs::write(folder.path().join("surface_000000.ply"), "ply\n").unwrap();
    assert!(refused(true, true).contains("surface_000000.ply"));
}

#[test]
fn names_become_identifiers() {
    assert_eq!(layer::identifier("gate of iron"), "gate_of_iron");
    assert_eq!(layer::identifier("2nd \"gate\""), "_2nd__gate_");
    assert_eq!(layer::identifier(""), "_");
}
