use std::f64::consts::PI;

use super::*;
use crate::output::npy;
use crate::scene::mesh::Mesh;

const RADIUS: f64 = 0.025;
/// Metres; far from zero, where single precision would show steps.
const CENTER: DVec3 = DVec3::new(1e5, -2e5, 3.0);
/// Of the ball, metres.
const SIZE: f64 = 0.5;

fn settings(format: usize, normals: bool) -> SurfaceSettings {
    SurfaceSettings {
        radius: None,
        smoothing_length: 2.0,
        cube_size: 0.75,
        threshold: 0.6,
        normals,
        format: &MESH_FORMATS[format],
        force: false,
        quiet: true,
    }
}

/// A ball of particles on a lattice, as a run's frame 7.
fn ball(folder: &Path) -> Sequence {
    let steps = -10..=10;
    let mut position = Vec::new();
    for x in steps.clone() {
        for y in steps.clone() {
            for z in steps.clone() {
                let offset = DVec3::new(x.into(), y.into(), z.into()) * 2.0 * RADIUS;
                if offset.length() < SIZE - 0.9 * RADIUS {
                    position.extend((CENTER + offset).to_array());
                }
            }
        }
    }
    let file = folder.join("position.npy");
    npy::write(&file, 3, &position).unwrap();
    Sequence {
        frames: vec![(7, file)],
        wanted: 1,
        radius: RADIUS,
        dimensions: 3,
    }
}

#[test]
fn a_ball_of_particles_becomes_a_closed_ball() {
    let folder = tempfile::tempdir().unwrap();
    let recorded = ball(folder.path());
    for (format, normals) in [(0, true), (1, true), (1, false)] {
        let mut settings = settings(format, normals);
        settings.force = true;
        let made = make_surfaces(&recorded, folder.path(), &settings).unwrap();
        assert_eq!((made.meshes, made.empty.len()), (1, 0));
        let path = folder
            .path()
            .join(format!("surface_000007.{}", settings.format.name));
        // OBJ is read in single precision, so its place far away is coarse; its shape is looked at nearer by in PLY's.
        let mesh = Mesh::load(&path).unwrap();
        assert!(mesh.triangles.len() > 1000);
        let (low, high) = mesh.bounds();
        assert!(((low + high) / 2.0).distance(CENTER) < 0.02, "{low} {high}");
        let text = std::fs::read(&path).unwrap();
        assert_eq!(
            String::from_utf8_lossy(&text).contains(["property float nx", "\nvn "][format]),
            normals
        );
    }
}

#[test]
fn the_surface_encloses_the_ball_and_faces_outward() {
    let folder = tempfile::tempdir().unwrap();
    let recorded = ball(folder.path());
    let mesh = surface(&recorded.frames[0].1, recorded.radius, &settings(0, true))
        .unwrap()
        .unwrap();
    for (vertex, normal) in mesh.vertices.iter().zip(&mesh.normals) {
        let from_center = *vertex - CENTER;
        assert!(
            (from_center.length() - SIZE).abs() < 2.0 * RADIUS,
            "{from_center}"
        );
        let outward = from_center.normalize().as_vec3().dot((*normal).into());
        assert!(outward > 0.5, "{outward}");
    }
    let closed = Mesh {
        vertices: mesh.vertices.iter().map(|v| *v - CENTER).collect(),
        triangles: mesh.triangles,
    };
    assert_eq!(closed.open_edges(), 0);
    let volume = closed.signed_volume() / (4.0 / 3.0 * PI * SIZE.powi(3));
    assert!((0.8..1.15).contains(&volume), "{volume} of the ball");
}

#[test]
fn meshes_that_are_there_stay() {
    let folder = tempfile::tempdir().unwrap();
    let recorded = ball(folder.path());
    let path = folder.path().join("surface_000007.ply");
    std::fs::write(&path, "mine").unwrap();
    let refused = make_surfaces(&recorded, folder.path(), &settings(0, true)).unwrap_err();
    assert!(refused.to_string().contains("--force"), "{refused}");
    assert_eq!(std::fs::read(&path).unwrap(), b"mine");
}

#[test]
fn a_fluids_particles_are_half_a_spacing_large() {
    let folder = tempfile::tempdir().unwrap();
    let frame = folder.path().join("particles_000000");
    std::fs::create_dir(&frame).unwrap();
    npy::write(&frame.join("position.npy"), 3, &[0.0; 3]).unwrap();
    let manifest =
        r#"{ "scene": { "dimensions": 3, "fluid": { "solver": "wcsph", "spacing": 0.05 } }, "frames": 1 }"#;
    std::fs::write(folder.path().join("run.json"), manifest).unwrap();
    let sequence = Sequence::open(folder.path()).unwrap();
    assert_eq!((sequence.radius, sequence.frames.len()), (RADIUS, 1));
}
