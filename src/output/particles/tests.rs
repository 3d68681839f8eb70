//! Columns and frames are chosen as said, and Sliceflow reads what it writes.

use std::path::Path;

use glam::DVec3;

use super::cloud::Moment;
use super::cloud::samples::flat;
use super::*;
use crate::scene::Dimensions;
use crate::scene::particle_file::load;
use crate::simulation::frame::{Frame, Values};

/// The sample in space, with what is left of doubles in single precision where a format has no more.
fn in_space() -> Frame {
    let mut frame = flat();
    for column in &mut frame.columns {
        match &mut column.values {
            Values::Double { columns, values } => {
                *columns = 3;
                *values = vec![0.5, -1.25, 0.1, 1e6 + 0.3, 3.0, -7.0];
            }
            Values::Vector { columns, values } => {
                *columns = 3;
                *values = vec![1.0, 2.0, -0.1, -3.0, 4.5, 6.0];
            }
            _ => {}
        }
    }
    frame
}

fn written(frame: &Frame, name: &str, folder: &Path) -> std::path::PathBuf {
    let format = FORMATS.iter().find(|format| format.name == name).unwrap();
    let wanted = columns_named(["position", "velocity", "id", "density"]).unwrap();
    (format.write)(&Moment::new(frame, &wanted), &folder.join("particles_000003")).unwrap();
    folder.join(
        format
            .file
            .replace("NNNNNN", "000003")
            .replace("COLUMN", "position"),
    )
}

#[test]
fn what_is_written_is_read_again() {
    let folder = tempfile::tempdir().unwrap();
    let exact = [DVec3::new(0.5, -1.25, 0.1), DVec3::new(1e6 + 0.3, 3.0, -7.0)];
    for format in FORMATS {
        let loaded = load(
            &written(&in_space(), format.name, folder.path()),
            Dimensions::Three,
        )
        .unwrap();
        let expected = exact.map(|p| {
            if format.is_single_precision {
                p.as_vec3().as_dvec3()
            } else {
                p
            }
        });
        assert_eq!(loaded.position, expected, "{}", format.name);
        if format.is_points {
            let velocity = [
                DVec3::new(1.0, 2.0, f64::from(-0.1f32)),
                DVec3::new(-3.0, 4.5, 6.0),
            ];
            assert_eq!(loaded.velocity.as_deref(), Some(&velocity[..]), "{}", format.name);
            assert_eq!(loaded.id, Some(vec![0, 1]), "{}", format.name);
        }
    }
}

#[test]
fn a_flat_scene_is_read_as_one() {
    let folder = tempfile::tempdir().unwrap();
    for format in FORMATS {
        let loaded = load(&written(&flat(), format.name, folder.path()), Dimensions::Two).unwrap();
        assert_eq!(loaded.position[0], DVec3::new(0.5, -1.25, 0.0), "{}", format.name);
    }
}

#[test]
fn files_that_are_cut_off_are_told() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["ply", "vtk", "bgeo"] {
        let path = written(&in_space(), name, folder.path());
        let whole = std::fs::read(&path).unwrap();
        for keep in [whole.len() / 3, whole.len() * 2 / 3] {
            std::fs::write(&path, &whole[..keep]).unwrap();
            let message = load(&path, Dimensions::Three).unwrap_err();
            assert!(message.contains("particles_000003"), "{name}: {message}");
        }
    }
}

#[test]
fn default_columns_exist() {
    let columns = columns_named(DEFAULT_COLUMNS.iter().copied()).unwrap();
    assert_eq!(columns.len(), DEFAULT_COLUMNS.len());
}

#[test]
fn columns_come_once_and_unknown_ones_are_told() {
    assert_eq!(columns_named(["speed", "id", "speed"]).unwrap().len(), 2);
    let message = columns_named(["mass"]).unwrap_err().to_string();
    assert!(
        message.contains("`mass`") && message.contains("position"),
        "{message}"
    );
}

#[test]
fn points_have_positions() {
    let names = |format: usize| {
        let output = ParticleOutput::new(vec![&FORMATS[format]], columns_named(["id"]).unwrap(), 1);
        output.columns.iter().map(|c| c.name).collect::<Vec<_>>()
    };
    for (index, format) in FORMATS.iter().enumerate() {
        assert_eq!(
            names(index).contains(&"position"),
            format.is_points,
            "{}",
            format.name
        );
    }
}

#[test]
fn every_nth_frame_counts_from_the_first() {
    let every = |n| ParticleOutput::new(Vec::new(), Vec::new(), n);
    assert_eq!([1, 2, 3, 100].map(|n| every(n).frames(31)), [31, 16, 11, 1]);
}
