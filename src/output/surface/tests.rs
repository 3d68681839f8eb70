use std::collections::HashMap;
use std::f64::consts::PI;

use super::*;
use crate::gpu::{AdapterChoice, Gpu};
use crate::output::npy;
use crate::scene::load::parse;
use crate::scene::mesh::Mesh;
use crate::scene::model::{Addressing, SurfaceKernel};

const RADIUS: f64 = 0.025;
/// Metres; far from zero, where single precision would show steps.
const CENTER: DVec3 = DVec3::new(1e5, -2e5, 3.0);
/// Radius of the ball, and half the edge of the box, metres.
const SIZE: f64 = 0.5;

fn settings(format: &str) -> SurfaceSettings {
    SurfaceSettings {
        radius: None,
        smoothing_length: 2.0,
        cube_size: 0.75,
        threshold: 0.55,
        smoothing: 25,
        cleanup: true,
        normals: true,
        columns: None,
        format: MESH_FORMATS.iter().find(|row| row.name == format).unwrap(),
        force: true,
        quiet: true,
    }
}

/// Particles on a lattice, as far from walls as fluids stand, moved a little from their places, the same way every time.
fn lattice(counts: [i32; 3], is_inside: impl Fn(DVec3) -> bool) -> Cloud {
    let mut position = Vec::new();
    let mut state = 1_u32;
    let mut shake = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (f64::from(state) / f64::from(u32::MAX) - 0.5) * 0.4 * RADIUS
    };
    for x in 0..counts[0] {
        for y in 0..counts[1] {
            for z in 0..counts[2] {
                let place = (DVec3::new(x.into(), y.into(), z.into()) + 0.5) * 2.0 * RADIUS;
                if is_inside(place) {
                    position.push(place + DVec3::new(shake(), shake(), shake()));
                }
            }
        }
    }
    Cloud {
        frame: 0,
        columns: vec![VertexColumn {
            name: "velocity".into(),
            width: 3,
            values: position.iter().flat_map(|p| [1.0, p.y as f32, 0.0]).collect(),
        }],
        position,
    }
}

/// Around [`CENTER`].
fn ball() -> Cloud {
    let mut cloud = lattice([24, 24, 24], |p| p.distance(DVec3::splat(0.6)) < SIZE);
    cloud.position.iter_mut().for_each(|p| *p += CENTER - 0.6);
    cloud
}

/// A run's frame 7.
fn record(cloud: &Cloud, folder: &Path) -> Sequence {
    let arrays = folder.join("particles_000007");
    std::fs::create_dir_all(&arrays).unwrap();
    let position: Vec<f64> = cloud.position.iter().flat_map(|p| p.to_array()).collect();
    npy::write(&arrays.join("position.npy"), 3, &position).unwrap();
    npy::write(&arrays.join("velocity.npy"), 3, &cloud.columns[0].values).unwrap();
    Sequence {
        frames: vec![(7, arrays)],
        wanted: 1,
        radius: RADIUS,
        dimensions: 3,
    }
}

fn made(cloud: &Cloud, walls: &Walls, settings: &SurfaceSettings) -> SurfaceMesh {
    surface(cloud, Path::new("particles"), RADIUS, walls, settings)
        .unwrap()
        .unwrap()
}

/// The volume of a mesh, once it is certain that there is one: every edge has two triangles, which agree.
fn volume(mesh: &SurfaceMesh) -> f64 {
    let mut halves = HashMap::new();
    for &[a, b, c] in &mesh.triangles {
        for half in [(a, b), (b, c), (c, a)] {
            *halves.entry(half).or_insert(0) += 1;
        }
    }
    for (&(a, b), &count) in &halves {
        assert_eq!((count, halves.get(&(b, a))), (1, Some(&1)), "edge {a}, {b}");
    }
    let first = mesh.vertices[0];
    let mesh = Mesh {
        vertices: mesh.vertices.iter().map(|v| *v - first).collect(),
        triangles: mesh.triangles.clone(),
    };
    mesh.signed_volume()
}

fn device(addressing: Addressing, kernel: SurfaceKernel) -> OnDevice {
    OnDevice::open(&AdapterChoice::Best, addressing, kernel).unwrap()
}

/// The device's mesh, with voxels as wide as half a spacing.
fn on(device: &OnDevice, cloud: &Cloud, walls: &Walls) -> SurfaceMesh {
    let mesh = device.reconstruct(cloud, 2.0 * RADIUS, RADIUS, walls, true);
    mesh.unwrap().unwrap()
}

/// All ways to make a mesh: splashsurf, and a device with either kernel.
fn each_way(check: impl Fn(&str, &dyn Fn(&Cloud, &Walls) -> SurfaceMesh)) {
    check("splashsurf", &|cloud, walls| made(cloud, walls, &settings("ply")));
    for kernel in [SurfaceKernel::Anisotropic, SurfaceKernel::Isotropic] {
        let device = device(Addressing::Bitmap, kernel);
        check(&format!("{kernel:?}"), &|cloud, walls| on(&device, cloud, walls));
    }
}

#[test]
fn a_ball_is_closed_faces_outward_and_has_its_volume() {
    each_way(|way, make| {
        let mesh = make(&ball(), &Walls::default());
        let share = volume(&mesh) / (4.0 / 3.0 * PI * SIZE.powi(3));
        assert!((share - 1.0).abs() < 0.02, "{way}: {share}");
        for (vertex, normal) in mesh.vertices.iter().zip(&mesh.normals) {
            let from_center = *vertex - CENTER;
            assert!(
                (from_center.length() - SIZE).abs() < RADIUS,
                "{way}: {from_center}"
            );
            let outward = from_center.normalize().as_vec3().dot((*normal).into());
            assert!(outward > 0.88, "{way}: {outward}");
        }
    });
}

#[test]
fn a_box_in_the_air_has_its_volume() {
    each_way(|way, make| {
        let mesh = make(&lattice([20, 20, 20], |_| true), &Walls::default());
        let share = volume(&mesh) / (2.0 * SIZE).powi(3);
        assert!((share - 1.0).abs() < 0.02, "{way}: {share}");
    });
}

#[test]
fn a_tank_at_rest_ends_at_its_walls_and_has_its_volume() {
    let scene = parse(TANK, "tank", Path::new("."), &["colliders=[]".into()]).unwrap();
    let (low, high) = (DVec3::new(100.0, 0.0, 0.0), DVec3::new(101.0, 9.0, 0.6));
    let mut cloud = lattice([20, 10, 12], |_| true);
    cloud.position.iter_mut().for_each(|p| *p += low);
    each_way(|way, make| {
        let mesh = make(&cloud, &Walls::of(&scene));
        let share = volume(&mesh) / 0.3;
        assert!((share - 1.0).abs() < 0.01, "{way}: {share}");
        let beyond = |v: &DVec3| (low - *v).max(*v - high).max_element();
        let worst = mesh.vertices.iter().map(beyond).fold(0.0, f64::max);
        assert!(worst < 1e-3 * RADIUS, "{way}: {worst} m");
    });
}

/// How far a surface that should be a plane is from it: root mean square and most of all vertices that `is_inner` says have
/// no other side near, in spacings.
fn off_plane(
    mesh: &SurfaceMesh,
    distance: impl Fn(DVec3) -> f64,
    is_inner: impl Fn(DVec3) -> bool,
) -> [f64; 2] {
    let inner = mesh.vertices.iter().copied().filter(|v| is_inner(*v));
    let off: Vec<f64> = inner.map(|v| distance(v).abs() / (2.0 * RADIUS)).collect();
    assert!(off.len() > 300, "{} vertices", off.len());
    let squares = off.iter().map(|d| d * d).sum::<f64>();
    [
        (squares / off.len() as f64).sqrt(),
        off.into_iter().fold(0.0, f64::max),
    ]
}

/// Particles are up to a tenth of a spacing off their places along each axis, and a lattice that is cut askew has steps of
/// half a spacing.
#[test]
fn a_tank_at_rest_and_a_box_cut_askew_end_in_planes() {
    let scene = parse(TANK, "tank", Path::new("."), &["colliders=[]".into()]).unwrap();
    let mut tank = lattice([20, 10, 12], |_| true);
    tank.position.iter_mut().for_each(|p| *p += DVec3::X * 100.0);
    let normal = DVec3::new(1.0, 2.0, 0.5).normalize();
    let middle = DVec3::splat(SIZE);
    let cut = lattice([20, 20, 20], |p| (p - middle).dot(normal) < 0.0);
    let far_from = |low: DVec3, high: DVec3| {
        move |v: DVec3| (v - low).min_element().min((high - v).min_element()) > 6.0 * RADIUS
    };
    each_way(|way, make| {
        let still = off_plane(
            &make(&tank, &Walls::of(&scene)),
            |v| v.y - 0.5,
            far_from(DVec3::new(100.0, 0.2, 0.0), DVec3::new(101.0, 0.8, 0.6)),
        );
        let askew = off_plane(
            &make(&cut, &Walls::default()),
            |v| (v - middle).dot(normal),
            far_from(DVec3::ZERO, DVec3::splat(2.0 * SIZE)),
        );
        assert!(still[0] < 0.06 && still[1] < 0.1, "{way}: {still:?} spacings off");
        assert!(askew[0] < 0.15 && askew[1] < 0.2, "{way}: {askew:?} spacings off");
    });
}

/// A mesh without holes has two more corners and faces than edges.
#[test]
fn a_sheet_of_one_layer_has_no_holes_and_stays_thin() {
    let cloud = lattice([16, 16, 1], |_| true);
    let whole = (cloud.position.len() as f64) * (2.0 * RADIUS).powi(3);
    for (kernel, thinnest, thickest) in [
        (SurfaceKernel::Anisotropic, 0.5, 1.0),
        (SurfaceKernel::Isotropic, 1.0, 1.5),
    ] {
        let mesh = on(&device(Addressing::Bitmap, kernel), &cloud, &Walls::default());
        let share = volume(&mesh) / whole;
        assert!((thinnest..thickest).contains(&share), "{kernel:?}: {share}");
        let more = mesh.vertices.len() as i64 - mesh.triangles.len() as i64 / 2;
        assert_eq!(more, 2, "{kernel:?}");
    }
}

#[test]
fn a_device_keeps_voxels_of_the_surface_alone() {
    let device = device(Addressing::Bitmap, SurfaceKernel::Anisotropic);
    on(&device, &ball(), &Walls::default());
    let figures = device.figures();
    assert!(figures.voxels < figures.box_voxels / 2, "{figures:?}");
    assert!(figures.bytes < figures.box_bytes, "{figures:?}");
}

/// Two drops, so far apart that the first tables are too small for the rows of voxels between them.
fn far_drops() -> Cloud {
    let step = 2.0 * RADIUS;
    Cloud {
        frame: 0,
        position: vec![CENTER, CENTER + DVec3::Z * 8000.0 * step],
        columns: Vec::new(),
    }
}

#[test]
fn a_device_keeps_what_fits_and_grows_what_does_not() {
    for addressing in [Addressing::Bitmap, Addressing::Rows] {
        let fresh = || device(addressing, SurfaceKernel::Anisotropic);
        let encode = settings("ply").format.encode;
        let alike = |kept: &OnDevice, cloud: &Cloud| {
            let mesh = on(kept, cloud, &Walls::default());
            assert!(volume(&mesh) > 0.0);
            let alone = on(&fresh(), cloud, &Walls::default());
            assert!(encode(&mesh) == encode(&alone), "{addressing:?}");
        };
        let kept = fresh();
        let few = lattice([4, 4, 4], |_| true);
        alike(&kept, &few);
        let compiled = kept.compiled();
        alike(&kept, &ball());
        alike(&kept, &far_drops());
        alike(&kept, &few);
        assert_eq!((kept.compiled(), compiled > 0), (compiled, true));
    }
}

#[test]
fn what_a_device_has_no_room_for_is_told() {
    let mut gpu = Gpu::open(&AdapterChoice::Best, false).unwrap();
    gpu.limits.binding = 1 << 20;
    let device = OnDevice::with(gpu, Addressing::Bitmap, SurfaceKernel::Anisotropic);
    let made = device.reconstruct(&far_drops(), 2.0 * RADIUS, RADIUS, &Walls::default(), true);
    let told = match made {
        Ok(_) => panic!("there was room in a mebibyte"),
        Err(error) => error.to_string(),
    };
    assert!(
        told.contains("`row_bounds`") && told.contains("devices"),
        "{told}"
    );
}

/// A voxel in memory between two slices, rows or words would be a seam or an island.
#[test]
fn a_devices_mesh_is_the_same_whatever_stores_it_and_in_every_run() {
    let mut cloud = ball();
    // A sheet, drops and a strand besides, so that cells are cut in all ways.
    let step = 2.0 * RADIUS;
    for i in 0..20 {
        let at = f64::from(i) * step;
        cloud.position.push(CENTER + DVec3::new(at - 0.5, 0.7, 0.02 * at));
        cloud.position.extend(
            (0..12).map(|k| CENTER + DVec3::new(0.8 + 0.1 * at, at - 0.5, f64::from(k) * step - 0.3)),
        );
        cloud
            .position
            .push(CENTER + DVec3::new(-0.9, 1.6 * at - 0.8, 0.3 * at * at));
    }
    let speeds = cloud.position.iter().flat_map(|p| [p.y as f32, 0.0, 0.0]);
    cloud.columns[0].values = speeds.collect();
    let encode = settings("ply").format.encode;
    let walls = Walls::default();
    for kernel in [SurfaceKernel::Anisotropic, SurfaceKernel::Isotropic] {
        let made = |addressing| {
            let device = device(addressing, kernel);
            (on(&device, &cloud, &walls), device.figures())
        };
        let (mesh, figures) = made(Addressing::Bitmap);
        let first = encode(&mesh);
        assert!(volume(&mesh) > 0.0);
        assert!(
            encode(&made(Addressing::Bitmap).0) == first,
            "{kernel:?}: two runs"
        );
        for addressing in [Addressing::Rows, Addressing::Sliced] {
            let (mesh, larger) = made(addressing);
            assert!(encode(&mesh) == first, "{kernel:?}, {addressing:?}");
            assert!(
                larger.voxels > figures.voxels,
                "{kernel:?}, {addressing:?}: {larger:?}"
            );
        }
    }
}

/// Distances in radii of a particle.
#[test]
fn a_devices_mesh_is_where_splashsurf_has_it() {
    let cloud = ball();
    let mesh = on(
        &device(Addressing::Bitmap, SurfaceKernel::Anisotropic),
        &cloud,
        &Walls::default(),
    );
    let other = made(&cloud, &Walls::default(), &settings("ply"));
    let nearest = |from: &DVec3| {
        let distances = other.vertices.iter().map(|to| from.distance(*to));
        distances.fold(f64::INFINITY, f64::min)
    };
    let distances: Vec<f64> = mesh.vertices.iter().step_by(7).map(nearest).collect();
    let mean = distances.iter().sum::<f64>() / distances.len() as f64;
    assert!(mean < 0.5 * RADIUS, "{} radii", mean / RADIUS);
}

#[test]
fn smoothing_takes_the_lumps_and_leaves_the_drops() {
    let mut cloud = ball();
    let roughness = |mesh: &SurfaceMesh| {
        let off = mesh.vertices.iter().map(|v| (v.distance(CENTER) - SIZE).powi(2));
        (off.sum::<f64>() / mesh.vertices.len() as f64).sqrt()
    };
    let (smooth, raw) = (
        settings("ply"),
        SurfaceSettings {
            smoothing: 0,
            cleanup: false,
            ..settings("ply")
        },
    );
    let [smoothed, rough] =
        [&smooth, &raw].map(|settings| roughness(&made(&cloud, &Walls::default(), settings)));
    assert!(smoothed < 0.7 * rough, "{smoothed} m instead of {rough} m");
    cloud.position = vec![CENTER];
    cloud.columns[0].values.truncate(3);
    let [drop, whole] = [&smooth, &raw].map(|settings| volume(&made(&cloud, &Walls::default(), settings)));
    assert!((drop / whole - 1.0).abs() < 0.15, "{drop} m³ of {whole} m³");
}

/// A tank with a pillar, far from zero, that is open above.
const TANK: &str = r#"{
    "domain": { "min": [100, 0, 0], "max": [101, 1, 0.6], "sides": { "y_max": "open" } },
    "fluid": { "spacing": 0.05 },
    "bodies": [{ "shape": { "kind": "box", "min": [100, 0, 0], "max": [100.1, 0.1, 0.1] } }],
    "time": { "duration": 1, "fps": 10 },
    "colliders": [
        { "shape": { "kind": "box", "min": [100.3, 0, 0.2], "max": [100.5, 0.8, 0.4] },
          "path": [{ "at": 0, "offset": [0, 0, 0] }, { "at": 1, "offset": [0.3, 0, 0] }] }
    ]
}"#;

#[test]
fn splashsurf_has_sharp_corners_at_walls_and_stands_through_them_without() {
    let scene = parse(TANK, "tank", Path::new("."), &["colliders=[]".into()]).unwrap();
    let (low, high) = (DVec3::new(100.0, 0.0, 0.0), DVec3::new(101.0, 9.0, 0.6));
    let mut cloud = lattice([20, 10, 12], |_| true);
    cloud.position.iter_mut().for_each(|p| *p += low);
    let mesh = made(&cloud, &Walls::of(&scene), &settings("ply"));
    let beyond = |v: &DVec3| (low - *v).max(*v - high).max_element();
    // Of what was moved onto walls (a third of the triangles) little has no area.
    let corners = [low, high.with_y(0.0), DVec3::new(100.0, 0.0, 0.6)];
    for corner in corners {
        let nearest = mesh
            .vertices
            .iter()
            .map(|v| v.distance(corner))
            .fold(f64::INFINITY, f64::min);
        assert!(nearest < 0.2 * RADIUS, "{nearest} m from {corner}");
    }
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|index| mesh.vertices[index as usize]);
        (b - a).cross(c - a).length() / 2.0
    };
    let flat = mesh
        .triangles
        .iter()
        .filter(|t| area(t) < 1e-3 * RADIUS * RADIUS)
        .count();
    assert!(
        10 * flat < mesh.triangles.len(),
        "{flat} of {}",
        mesh.triangles.len()
    );
    // Without walls it stands through them.
    let mesh = made(&cloud, &Walls::default(), &settings("ply"));
    assert!(mesh.vertices.iter().any(|v| beyond(v) > 0.1 * RADIUS));
}

#[test]
fn surfaces_end_at_obstacles_where_they_are_then() {
    let scene = parse(TANK, "tank", Path::new("."), &[]).unwrap();
    let walls = Walls::of(&scene);
    let pillar = |frame: u32, inner: f64| {
        let offset = DVec3::new(100.0 + 0.03 * f64::from(frame), 0.0, 0.0);
        move |p: DVec3| {
            (p - offset - DVec3::new(0.4, 0.4, 0.3))
                .abs()
                .cmple(DVec3::new(0.1, 0.4, 0.1) - inner)
                .all()
        }
    };
    for frame in [0, 10] {
        let (inside, deep) = (pillar(frame, 0.0), pillar(frame, 1e-3 * RADIUS));
        let mut cloud = lattice([20, 10, 12], |p| !inside(p + DVec3::new(100.0, 0.0, 0.0)));
        cloud.frame = frame;
        cloud.position.iter_mut().for_each(|p| p.x += 100.0);
        let deepest = |mesh: &SurfaceMesh| mesh.vertices.iter().filter(|&&v| deep(v)).count();
        let (ended, through) = (
            made(&cloud, &walls, &settings("ply")),
            made(&cloud, &Walls::default(), &settings("ply")),
        );
        assert!(deepest(&through) > 100 && deepest(&ended) < deepest(&through) / 10);
        volume(&ended);
    }
}

#[test]
fn vertices_have_the_values_of_the_particles_around_them() {
    let cloud = lattice([20, 10, 12], |_| true);
    each_way(|way, make| {
        let mesh = make(&cloud, &Walls::default());
        for (i, vertex) in mesh.vertices.iter().enumerate() {
            let [x, y, z] = mesh.columns[0].row(i) else {
                panic!("a velocity has three components")
            };
            assert!((x - 1.0).abs() < 1e-5 && z.abs() < 1e-5, "{way}: {x} {z}");
            // A vertex lies outside, and all that it takes the mean of inside: by half a spacing or a little more.
            assert!(
                (f64::from(*y) - vertex.y).abs() < 2.0 * RADIUS,
                "{way}: {y} at {vertex}"
            );
        }
    });
}

#[test]
fn two_runs_give_the_same_bytes_in_files_that_are_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let recorded = record(&ball(), folder.path());
    for row in MESH_FORMATS {
        let path = folder.path().join(format!("surface_000007.{}", row.name));
        let bytes = [(); 2].map(|()| {
            let made = make_surfaces(
                &recorded,
                &Walls::default(),
                folder.path(),
                &settings(row.name),
                None,
            )
            .unwrap();
            assert_eq!((made.meshes, made.empty.len()), (1, 0));
            std::fs::read(&path).unwrap()
        });
        assert!(bytes[0] == bytes[1], "{}", row.name);
        assert!(is_surface(&path), "{}", row.name);
        if row.name == "glb" {
            continue;
        }
        // OBJ is read in single precision, so its place far away is coarse.
        let mesh = Mesh::load(&path).unwrap();
        assert!(mesh.triangles.len() > 1000);
        let (low, high) = mesh.bounds();
        assert!(((low + high) / 2.0).distance(CENTER) < 0.02, "{low} {high}");
        let text = String::from_utf8_lossy(&bytes[0]).into_owned();
        let named = if row.name == "ply" {
            "property float vx"
        } else {
            "\nvn "
        };
        assert!(text.contains(named), "{}", row.name);
    }
}

/// The specification's rules for what trimesh, which opens such files in tests/readers.rs, does not look at.
#[test]
fn a_glb_file_holds_what_the_mesh_does() {
    let mesh = made(&ball(), &Walls::default(), &settings("glb"));
    let file = (settings("glb").format.encode)(&mesh);
    let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!((&file[..4], word(4), word(8)), (&b"glTF"[..], 2, file.len()));
    let (text, second) = (word(12), 20 + word(12));
    assert_eq!(
        (&file[16..20], &file[second + 4..second + 8]),
        (&b"JSON"[..], &b"BIN\0"[..])
    );
    assert!(text % 4 == 0 && word(second) % 4 == 0 && second + 8 + word(second) == file.len());
    let told: serde_json::Value = serde_json::from_slice(&file[20..second]).unwrap();
    let values = |accessor: &serde_json::Value| -> Vec<[u8; 4]> {
        let accessor = &told["accessors"][accessor.as_u64().unwrap() as usize];
        let view = &told["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
        let number = |key: &str| view[key].as_u64().unwrap() as usize;
        let bytes = &file[second + 8 + number("byteOffset")..][..number("byteLength")];
        let width = if accessor["type"] == "VEC3" { 3 } else { 1 };
        assert_eq!(
            bytes.len(),
            4 * width * accessor["count"].as_u64().unwrap() as usize
        );
        bytes.as_chunks().0.to_vec()
    };
    let primitive = &told["meshes"][0]["primitives"][0];
    let floats = |name: &str| -> Vec<f32> {
        values(&primitive["attributes"][name])
            .into_iter()
            .map(f32::from_le_bytes)
            .collect()
    };
    let indices: Vec<u32> = values(&primitive["indices"])
        .into_iter()
        .map(u32::from_le_bytes)
        .collect();
    assert_eq!(indices, mesh.triangles.as_flattened());
    assert_eq!(floats("NORMAL"), mesh.normals.as_flattened());
    assert_eq!(floats("_VELOCITY"), mesh.columns[0].values);
    let corner = told["nodes"][0]["translation"].as_array().unwrap();
    let corner = DVec3::from([0, 1, 2].map(|axis| corner[axis].as_f64().unwrap()));
    let place = floats("POSITION");
    for (place, vertex) in place.as_chunks::<3>().0.iter().zip(&mesh.vertices) {
        assert!((DVec3::from(place.map(f64::from)) + corner).distance(*vertex) < 1e-6);
    }
    let accessor = &told["accessors"][primitive["attributes"]["POSITION"].as_u64().unwrap() as usize];
    let least = place.iter().copied().reduce(f32::min).unwrap();
    assert_eq!(
        (least, accessor["min"][1].as_f64()),
        (0.0, Some(0.0)),
        "places count from the mesh's corner"
    );
}

#[test]
fn columns_that_the_files_lack_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let recorded = record(&ball(), folder.path());
    let refused = |columns: &str| {
        let settings = SurfaceSettings {
            columns: Some(vec![columns.into()]),
            ..settings("ply")
        };
        make_surfaces(&recorded, &Walls::default(), folder.path(), &settings, None)
            .unwrap_err()
            .to_string()
    };
    let told = refused("pressure");
    assert!(
        told.contains("no column `pressure`") && told.contains("velocity"),
        "{told}"
    );
}

#[test]
fn meshes_that_are_there_stay() {
    let folder = tempfile::tempdir().unwrap();
    let recorded = record(&ball(), folder.path());
    let path = folder.path().join("surface_000007.ply");
    std::fs::write(&path, "mine").unwrap();
    let settings = SurfaceSettings {
        force: false,
        ..settings("ply")
    };
    let refused = make_surfaces(&recorded, &Walls::default(), folder.path(), &settings, None).unwrap_err();
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
