//! Scenes and what they name.

use std::fs;
use std::io::Write as _;
use std::os::unix::fs::symlink;
use std::process::Command;

use super::{answer, bounded, mesh_scene, plain, refused};
use crate::place::Place;

#[test]
fn scenes_that_ask_for_too_much_are_refused_before_anything_is_made() {
    refused(&[
        (&["plan", "wide_box.json"], "would hold about 2.5e7 particles"),
        (&["plan", "fine_spacing.json"], "--max-memory"),
        (&["plan", "tall_box.json"], "would hold about 7840000 particles"),
        (&["plan", "far_drop.json"], "is too large"),
        (
            &["plan", "tall_domain.json"],
            "single precision rounds coordinates",
        ),
        (
            &["plan", "wide_emitters.json"],
            "its first layer reaches out of the domain",
        ),
        (&["plan", "endless_box.json"], "is too large"),
        (&["plan", "deep_box.json"], "z is 1e308 in a 2D scene"),
        (&["plan", "far_mesh.json"], "is too large"),
        (&["plan", "endless_drop.json"], "is too large"),
        (
            &["plan", "dam_break_2d", "--set", "fluid.spacing=1e-6"],
            "take about 1.2e7 boundary particles",
        ),
        (
            &[
                "plan",
                "dam_break_2d",
                "--set",
                r#"colliders=[{"shape":{"kind":"box","min":[0.6,0],"max":[1e60,1]}}]"#,
            ],
            "is too large",
        ),
        (
            &[
                "plan",
                "green_cube",
                "--set",
                r#"bodies=[{"shape":{"kind":"sphere","center":[1e60,0,0],"radius":0.1}}]"#,
            ],
            "is too large",
        ),
        (
            &[
                "plan",
                "dam_break_2d",
                "--set",
                r#"colliders=[{"shape":{"kind":"sphere","center":[0.7,0.5],"radius":1e6}}]"#,
            ],
            "boundary particles",
        ),
        (
            &[
                "plan",
                "harada_droplet",
                "--set",
                r#"colliders=[{"shape":{"kind":"sphere","center":[0.7,-0.5,0.5],"radius":1e6}}]"#,
            ],
            "boundary particles",
        ),
        (
            &[
                "plan",
                "harada_droplet",
                "--set",
                "fluid.spacing=0.02",
                "--set",
                "domain.max=[1e4,1,1e4]",
            ],
            "boundary particles",
        ),
        (
            &["plan", "taylor_couette", "--set", "bodies[0].shape.outer=1e6"],
            "would hold about",
        ),
        (
            &[
                "plan",
                "green_cube",
                "--set",
                r#"emitters=[{"name":"e","center":[0,0.5,0],"radius":1e6,"velocity":[0,-1,0]}]"#,
            ],
            "its first layer reaches out of the domain",
        ),
        (
            &[
                "plan",
                "column_2d",
                "--set",
                r#"emitters=[{"name":"e","center":[0.5,0.5],"radius":1e6,"velocity":[0,-1]}]"#,
            ],
            "its first layer reaches out of the domain",
        ),
        (
            &["plan", "lid_cavity", "--set", "bodies[0].shape.max=[1e5,0.1]"],
            "would hold about 2.5e7 particles",
        ),
        (
            &["plan", "small3d.json", "--set", "domain.max=[1e7,1,0.3]"],
            "single precision rounds coordinates",
        ),
        (
            &["plan", "small3d.json", "--max-particles", "50"],
            "at most 50 particles",
        ),
        (&["plan", "small3d.json", "--max-memory", "1kB"], "--max-memory"),
    ]);
}

#[test]
fn files_whose_headers_announce_too_much_are_refused() {
    let scene = |name: &str| format!("scene_of_{name}.json");
    let cases = [
        ("braces_npy", "header is not NumPy's"),
        ("shape_abort_npy", "the array is cut off"),
        ("shape_panic_npy", "larger than any memory"),
        ("shape_overflow2_npy", "larger than any memory"),
        ("components_abort_vtp", "components"),
        ("components_panic_vtp", "components"),
        ("points_panic_vtp", "announces more numbers than it holds"),
        ("zero_property_ply", "is more than its 72 bytes hold"),
    ];
    let cases = cases.map(|(name, expected)| (scene(name), expected));
    for (name, expected) in &cases {
        refused(&[(&["plan", name], expected)]);
    }
    let folder = tempfile::tempdir().unwrap();
    let put = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
    let mut bomb = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    bomb.write_all(b"BgeoV\0\0\0\x05\x7f\xff\xff\xff").unwrap();
    for _ in 0..200 {
        bomb.write_all(&[0; 1 << 20]).unwrap();
    }
    put("bomb.bgeo", &bomb.finish().unwrap());
    fs::copy("tests/attack/bomb.json", folder.path().join("bomb.json")).unwrap();
    let path = folder.path().join("bomb.json");
    refused(&[(&["plan", path.to_str().unwrap()], "unpack to more than")]);
    // The count of a binary STL.
    put("a.stl", &[[0; 80].as_slice(), &[0xff; 4], &[0; 100]].concat());
    put("pipe.json", mesh_scene("pipe.ply").as_bytes());
    put("zero.json", mesh_scene("zero.ply").as_bytes());
    put("stl.json", mesh_scene("a.stl").as_bytes());
    let pipe = folder.path().join("pipe.ply");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let at = |name: &str| folder.path().join(name).display().to_string();
    refused(&[
        (&["plan", &at("stl.json")], "is cut off"),
        (&["plan", &at("pipe.json")], "a pipe or a device"),
        (
            &[
                "plan",
                &at("zero.json"),
                "--set",
                "bodies[0].shape.file=/dev/zero.ply",
            ],
            "zero.ply",
        ),
    ]);
}

/// Materials of an OBJ are not used, so that whatever it names in their place is not opened: an endless device, say.
#[test]
fn materials_are_not_opened() {
    for scene in ["scene_of_mtl_zero_obj.json", "scene_of_mtl_passwd_obj.json"] {
        let (status, told) = answer(&mut bounded(&["plan", scene]));
        assert_eq!(status, Some(0), "{scene}: {told}");
    }
}

#[test]
fn scenes_read_files_of_their_own_folder_and_of_those_that_are_allowed() {
    let place = Place::new();
    fs::create_dir(place.path("inside")).unwrap();
    fs::copy("tests/attack/cube.obj", place.path("cube.obj")).unwrap();
    let scene = |name: &str, file: &str| fs::write(place.path(name), mesh_scene(file)).unwrap();
    scene("inside/up.json", "../cube.obj");
    scene("inside/linked.json", "link.obj");
    scene("inside/secret.json", "/etc/passwd.csv");
    symlink(place.path("cube.obj"), place.path("inside/link.obj")).unwrap();
    let absolute = place.path("cube.obj").display().to_string();
    scene("inside/absolute.json", &absolute);
    let plan = |args: &[&str]| answer(&mut plain(&place, &[&["plan"], args].concat()));
    for name in ["up", "linked", "absolute"] {
        let path = format!("inside/{name}.json");
        let (status, told) = plan(&[&path]);
        assert!(
            status == Some(2) && told.contains("outside of the scene's folder"),
            "{name}: {told}"
        );
        assert!(told.contains("--allow-read"), "{told}");
        let (status, told) = plan(&[&path, "--allow-read", "."]);
        assert_eq!(status, Some(0), "{name}: {told}");
    }
    // What the command line names is allowed.
    let set = format!("bodies[0].shape.file={absolute}");
    assert_eq!(plan(&["inside/secret.json", "--set", &set]).0, Some(0));
    assert_eq!(plan(&["bunny_pour"]).0, Some(0));
}

#[test]
fn odd_columns_and_ranges_are_refused_or_drawn() {
    let place = Place::new();
    place.told(&mut place.run("run", &["--frames", "1"]), 0);
    let position = place.path("run/particles_000000/position.npy");
    let array = |shape: &str, numbers: usize| {
        let mut header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}, }}");
        header += &" ".repeat((64 - (11 + header.len()) % 64) % 64);
        header.push('\n');
        let length = (header.len() as u16).to_le_bytes();
        [
            b"\x93NUMPY\x01\x00".as_slice(),
            &length,
            header.as_bytes(),
            &vec![0; 4 * numbers],
        ]
        .concat()
    };
    for (shape, numbers) in [("(5, 0)", 0), ("(5,)", 5), ("(5, 7)", 35), ("(5, 1, 2)", 10)] {
        fs::write(&position, array(shape, numbers)).unwrap();
        for args in [
            &["diff", "run", "run"][..],
            &["render", "run", "--set", "render.color.by=y"],
        ] {
            let output = plain(&place, args).output().unwrap();
            let told = String::from_utf8_lossy(&output.stderr);
            assert!(
                told.contains("help:") && !told.contains("panicked"),
                "{shape}, {args:?}: {told}"
            );
        }
    }
    let narrow = [
        "--frames",
        "1",
        "--no-statistics",
        "--set",
        "render.color.range=[0,5e-324]",
    ];
    place.told(&mut place.run("narrow", &narrow), 0);
}

#[cfg(feature = "surface")]
#[test]
fn surfaces_of_cubes_that_make_no_sense_are_refused() {
    let place = Place::new();
    let scene = fs::read_to_string("tests/attack/small3d.json").unwrap();
    fs::write(place.path("scene.json"), scene).unwrap();
    place.told(&mut place.run("run", &["--frames", "1", "--no-pictures"]), 0);
    for (size, expected) in [
        ("1e9", "larger than what the kernel reaches"),
        ("1e-9", "along one side"),
    ] {
        let (_, told) = answer(&mut plain(&place, &["surface", "run", "--cube-size", size]));
        assert!(told.contains(expected) && told.contains("help:"), "{told}");
    }
}

/// The program needs no folder for temporary files where a scene names no meshes.
#[test]
fn a_missing_folder_for_temporary_files_stops_no_scene_without_meshes() {
    let mut command = bounded(&["plan", "green_cube"]);
    let (status, told) = answer(command.env("TMPDIR", "/dev/null/folder"));
    assert_eq!(status, Some(0), "{told}");
    let (status, told) = answer(bounded(&["plan", "bunny_pour"]).env("TMPDIR", "/dev/null/folder"));
    assert!(status == Some(1) && told.contains("TMPDIR"), "{told}");
}
