//! What is read, and what is refused and told.

use std::fs;
use std::path::PathBuf;

use super::*;
use crate::output::npy;
use Dimensions::{Three, Two};

fn file(folder: &tempfile::TempDir, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    path
}

/// Two particles with velocity and id, in the formats that can carry them.
#[test]
fn ply_and_csv_give_the_same_particles() {
    let folder = tempfile::tempdir().unwrap();
    let header = |encoding: &str| {
        format!(
            "ply\nformat {encoding} 1.0\ncomment made by a test\nelement vertex 2\nproperty float x\n\
             property double y\nproperty float z\nproperty float velocity_x\nproperty float velocity_y\n\
             property float velocity_z\nproperty uint id\nproperty uchar red\nend_header\n"
        )
    };
    let rows = [
        ([0.5f32, 2.0], 0.1f64, [3.0f32, -4.0, 1e-3], 4_000_000_000u32),
        ([-1.5, 0.25], 7.0, [0.0, 0.0, 9.0], 3),
    ];
    let binary = |big: bool| {
        let mut bytes = header(["binary_little_endian", "binary_big_endian"][usize::from(big)]).into_bytes();
        let mut put = |mut number: Vec<u8>| {
            if big {
                number.reverse();
            }
            bytes.extend(number);
        };
        for ([x, z], y, velocity, id) in rows {
            put(x.to_le_bytes().to_vec());
            put(y.to_le_bytes().to_vec());
            put(z.to_le_bytes().to_vec());
            velocity.iter().for_each(|v| put(v.to_le_bytes().to_vec()));
            put(id.to_le_bytes().to_vec());
            put(vec![255]);
        }
        bytes
    };
    let mut ascii = header("ascii");
    let mut csv = "\u{feff}# a comment\n\nID, x,Y,z,vx,vy,vz,speed\n".to_owned();
    for ([x, z], y, [vx, vy, vz], id) in rows {
        ascii += &format!("{x} {y} {z} {vx} {vy} {vz} {id} 255\n");
        // What f32 holds, in full.
        let vz = f64::from(vz);
        csv += &format!("{id},{x}, {y},{z},{vx},{vy},{vz},fast\r\n");
    }

    let expected = Loaded {
        position: vec![DVec3::new(0.5, 0.1, 2.0), DVec3::new(-1.5, 7.0, 0.25)],
        velocity: Some(vec![
            DVec3::new(3.0, -4.0, f64::from(1e-3f32)),
            DVec3::new(0.0, 0.0, 9.0),
        ]),
        id: Some(vec![4_000_000_000, 3]),
        radius: None,
    };
    for (name, bytes) in [
        ("little.ply", binary(false)),
        ("big.ply", binary(true)),
        ("ascii.PLY", ascii.into_bytes()),
        ("table.csv", csv.into_bytes()),
    ] {
        let loaded = load(&file(&folder, name, bytes), Three);
        assert_eq!(loaded.as_ref(), Ok(&expected), "{name}");
    }
}

#[test]
fn csv_without_a_header_holds_positions() {
    let folder = tempfile::tempdir().unwrap();
    let flat = file(&folder, "flat.csv", "1,2\n3,4.5e0\n");
    let loaded = load(&flat, Two).unwrap();
    assert_eq!(
        loaded.position,
        [DVec3::new(1.0, 2.0, 0.0), DVec3::new(3.0, 4.5, 0.0)]
    );
    assert_eq!((loaded.velocity, loaded.id), (None, None));
    let deep = file(&folder, "deep.csv", "1,2,3");
    assert_eq!(load(&deep, Three).unwrap().position, [DVec3::new(1.0, 2.0, 3.0)]);
}

#[test]
fn positions_alone_follow_the_columns_and_the_rows() {
    let folder = tempfile::tempdir().unwrap();
    let flat = file(&folder, "flat.csv", "y,id,x,vx\n2,7,1,nan\n4,7,3,0\n");
    let (position, dimensions) = load_positions(&flat, None).unwrap();
    assert_eq!(position, [DVec3::new(1.0, 2.0, 0.0), DVec3::new(3.0, 4.0, 0.0)]);
    assert_eq!(dimensions, Two);
    let deep = file(&folder, "deep.csv", "1,2,0\n1,2,nan\n");
    let message = load_positions(&deep, None).unwrap_err();
    assert!(message.contains("deep.csv: line 2: z is NaN"), "{message}");
    assert!(
        load_positions(&flat, Some(Three))
            .unwrap_err()
            .contains("z is missing")
    );
}

#[test]
fn npy_of_both_widths_precisions_and_orders() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("position.npy");
    let (first, second) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 5.0, 6.5));

    npy::write(&path, 3, &[1.0f32, 2.0, 3.0, 4.0, 5.0, 6.5]).unwrap();
    assert_eq!(load(&path, Three).unwrap().position, [first, second]);
    npy::write(&path, 2, &[1.0f64, 2.0, 4.0, 5.0]).unwrap();
    assert_eq!(
        load(&path, Two).unwrap().position,
        [first.with_z(0.0), second.with_z(0.0)]
    );
    assert!(load(&path, Three).unwrap_err().contains("z is missing"));

    let header = "{'descr': '>f8', 'fortran_order': True, 'shape': (2, 3), }\n";
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(
        [1.0f64, 4.0, 2.0, 5.0, 3.0, 6.5]
            .iter()
            .flat_map(|x| x.to_be_bytes()),
    );
    fs::write(&path, bytes).unwrap();
    assert_eq!(load(&path, Three).unwrap().position, [first, second]);
}

#[test]
fn broken_files_are_told_by_place_and_mend() {
    let folder = tempfile::tempdir().unwrap();
    let ply = |properties: &str, rows: &str| {
        let count = rows.lines().count();
        format!("ply\nformat ascii 1.0\nelement vertex {count}\n{properties}end_header\n{rows}")
    };
    let xyz = "property float x\nproperty float y\nproperty float z\n";
    for (name, text, dimensions, expected) in [
        (
            "a.csv",
            "x,y,z\n0,0,0\n\n1,nan,0\n".into(),
            Three,
            "line 4: y is NaN",
        ),
        ("b.csv", "x,y\n0,0\n0,inf\n".into(), Two, "line 3: y is inf"),
        (
            "c.csv",
            "x,y\n0,0\n0,0,0\n".into(),
            Two,
            "line 3: 3 columns instead of 2",
        ),
        (
            "d.csv",
            "0,0,0,0\n".into(),
            Three,
            "line 1: 4 columns without a header",
        ),
        ("e.csv", "x,y\n0,zero\n".into(), Two, "line 2: y is \"zero\""),
        ("f.csv", String::new(), Two, "empty"),
        ("g.csv", "x,y\n".into(), Two, "no particles"),
        ("h.csv", "x,y\n0,0\n".into(), Three, "z is missing"),
        (
            "i.csv",
            "x,y,z\n0,0,0\n0,0,0.1\n".into(),
            Two,
            "line 3: z is 0.1 in 2D",
        ),
        (
            "j.csv",
            "x,y,id\n0,0,5\n0,0,6\n0,0,5\n".into(),
            Two,
            "line 4: id 5 is that of line 2",
        ),
        ("k.csv", "x,y,id\n0,0,1.5\n".into(), Two, "line 2: id is 1.5"),
        ("l.csv", "x,y,id\n0,0,-1\n".into(), Two, "line 2: id is -1"),
        ("m.csv", "x,y,vx\n0,0,1\n".into(), Two, "1 of 2 components"),
        ("n.csv", "x,y,X\n0,0,1\n".into(), Two, "column x is there twice"),
        (
            "o.csv",
            "x,y,vx,vy,vz\n0,0,0,0,2\n".into(),
            Two,
            "line 2: vz is 2",
        ),
        ("p.ply", ply(xyz, "0 0 0\n0 nan 0\n"), Three, "Line 9"),
        (
            "q.ply",
            ply("property float x\nproperty float y\n", "0 0\n"),
            Three,
            "z is missing",
        ),
        ("r.ply", ply(xyz, ""), Three, "no particles"),
        ("s.ply", "ply\nformat".into(), Three, "not a readable PLY"),
        ("t.npy", "not numpy".into(), Three, "numpy.save"),
        ("u.txt", "0 0 0".into(), Three, ".ply, .vtp, .bgeo, .csv and .npy"),
    ] {
        let message = load(&file(&folder, name, text), dimensions).unwrap_err();
        assert!(
            message.contains(name) && message.contains(expected),
            "{name}: {message}"
        );
    }

    let path = folder.path().join("v.npy");
    npy::write(&path, 4, &[0.0f32; 8]).unwrap();
    assert!(load(&path, Three).unwrap_err().contains("[2, 4]"));
    npy::write(&path, 3, &[0i32; 6]).unwrap();
    assert!(
        load(&path, Three)
            .unwrap_err()
            .contains("save float32 or float64")
    );
    npy::write(&path, 3, &[0.0, 0.0, 0.0, f64::NAN, 0.0, 0.0]).unwrap();
    assert!(load(&path, Three).unwrap_err().contains("row 1: x is NaN"));
    npy::write::<f32>(&path, 3, &[]).unwrap();
    assert!(load(&path, Three).unwrap_err().contains("no particles"));
    assert!(
        load(&folder.path().join("absent.csv"), Three)
            .unwrap_err()
            .contains("absent.csv")
    );
}
