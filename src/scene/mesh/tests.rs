use std::fs;
use std::path::{Path, PathBuf};

use glam::DVec3;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::samples::{ball, cube, torus};
use super::{Mesh, surface::Surface};

/// A tetrahedron of volume 1/6, faces outward, in every format that is read.
fn tetrahedron_files(folder: &Path) -> Vec<PathBuf> {
    let ascii_stl = {
        let corners = ["0 0 0", "1 0 0", "0 1 0", "0 0 1"];
        let facet = |face: [usize; 3]| {
            let vertices = face.map(|i| format!("vertex {}\n", corners[i])).concat();
            format!("facet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet\n")
        };
        let facets = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(facet).concat();
        format!("solid\n{facets}endsolid\n").into_bytes()
    };
    let mut binary_stl = Vec::new();
    let triangles: Vec<_> = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
        .iter()
        .map(|face| {
            let corner = |i: usize| {
                let mut at = [0.0f32; 3];
                if i > 0 {
                    at[i - 1] = 1.0;
                }
                stl_io::Vertex::new(at)
            };
            stl_io::Triangle {
                normal: stl_io::Normal::new([0.0; 3]),
                vertices: face.map(corner),
            }
        })
        .collect();
    stl_io::write_stl(&mut binary_stl, triangles.iter()).unwrap();

    let ply_header = |encoding: &str| {
        format!(
            "ply\nformat {encoding} 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
             element face 4\nproperty list uchar int vertex_indices\nend_header\n"
        )
    };
    let ascii_ply = ply_header("ascii") + "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
    let mut binary_ply = ply_header("binary_little_endian").into_bytes();
    for value in [0f32, 0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1.] {
        binary_ply.extend(value.to_le_bytes());
    }
    for face in [[0i32, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] {
        binary_ply.push(3);
        binary_ply.extend(face.iter().flat_map(|index| index.to_le_bytes()));
    }
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\ng other\nf 1// 2// 4//\nf -4 -1 -2\nf 2 3 4\n";

    [
        ("a.obj", obj.as_bytes().to_vec()),
        ("ascii.ply", ascii_ply.into_bytes()),
        ("binary.ply", binary_ply),
        ("ascii.stl", ascii_stl),
        ("binary.STL", binary_stl),
    ]
    .map(|(name, bytes)| {
        let path = folder.join(name);
        fs::write(&path, bytes).unwrap();
        path
    })
    .to_vec()
}

#[test]
fn every_format_gives_the_same_tetrahedron() {
    let folder = tempfile::tempdir().unwrap();
    for path in tetrahedron_files(folder.path()) {
        let name = path.display();
        let mesh = Mesh::load(&path).unwrap();
        assert_eq!(mesh.vertices.len(), 4, "{name}");
        assert_eq!(mesh.triangles.len(), 4, "{name}");
        assert_eq!(mesh.open_edges(), 0, "{name}");
        assert_eq!(mesh.bounds(), (DVec3::ZERO, DVec3::ONE), "{name}");
        assert!((mesh.signed_volume() - 1.0 / 6.0).abs() < 1e-15, "{name}");
    }
}

/// Its header begins like that of ASCII files, and no byte of it is beyond ASCII.
#[test]
fn a_binary_stl_may_begin_with_solid() {
    let mut bytes = Vec::new();
    let triangle = stl_io::Triangle {
        normal: stl_io::Normal::new([0.0; 3]),
        vertices: [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]].map(stl_io::Vertex::new),
    };
    stl_io::write_stl(&mut bytes, [triangle].iter()).unwrap();
    bytes[..6].copy_from_slice(b"solid ");
    assert!(bytes.is_ascii());

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("solid.stl");
    fs::write(&path, bytes).unwrap();
    let mesh = Mesh::load(&path).unwrap();
    assert_eq!((mesh.triangles.len(), mesh.open_edges()), (1, 3));
}

#[test]
fn polygons_are_fanned() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cube.obj");
    let mut text = String::new();
    for v in cube(DVec3::ZERO, DVec3::ONE).vertices {
        text += &format!("v {} {} {}\n", v.x, v.y, v.z);
    }
    text += "f 1 5 7 3\nf 2 4 8 6\nf 1 2 6 5\nf 3 7 8 4\nf 1 3 4 2\nf 5 6 8 7\n";
    fs::write(&path, &text).unwrap();
    let from_obj = Mesh::load(&path).unwrap();
    assert_eq!(from_obj.triangles.len(), 12);
    assert_eq!(from_obj.open_edges(), 0);
    assert!((from_obj.signed_volume() - 1.0).abs() < 1e-12);

    let path = folder.path().join("cube.ply");
    let mut text =
        "ply\nformat ascii 1.0\nelement vertex 8\nproperty double x\nproperty double y\nproperty double z\n\
                    property uchar red\nelement face 6\nproperty list uchar uint vertex_index\nend_header\n"
            .to_owned();
    for v in cube(DVec3::ZERO, DVec3::ONE).vertices {
        text += &format!("{} {} {} 255\n", v.x, v.y, v.z);
    }
    text += "4 0 4 6 2\n4 1 3 7 5\n4 0 1 5 4\n4 2 6 7 3\n4 0 2 3 1\n4 4 5 7 6\n";
    fs::write(&path, &text).unwrap();
    let from_ply = Mesh::load(&path).unwrap();
    assert_eq!(from_ply.triangles.len(), 12);
    assert_eq!(from_ply.open_edges(), 0);
    assert!((from_ply.signed_volume() - 1.0).abs() < 1e-12);
}

#[test]
fn broken_files_are_named_with_their_mend() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
               element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    let files = [
        ("cloud.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n".into(), "no faces"),
        (
            "flat.obj",
            "v 0 0 0\nv 0 0 0\nv 0 1 0\nf 1 2 3\n".into(),
            "no faces",
        ),
        ("range.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n".into(), "export"),
        (
            "range.ply",
            format!("{ply}0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
            "names vertex 3",
        ),
        (
            "below.ply",
            format!("{ply}0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n"),
            "names vertex -1",
        ),
        (
            "nan.ply",
            format!("{ply}0 0 0\nnan 0 0\n0 1 0\n3 0 1 2\n"),
            "Line 11",
        ),
        (
            "flat.ply",
            format!("{ply}0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").replace("property float z\n", ""),
            "no property z",
        ),
        ("short.ply", format!("{ply}0 0 0\n"), "not a readable PLY"),
        (
            "nan.obj",
            "v 0 0 0\nv NaN 0 0\nv 0 1 0\nf 1 2 3\n".into(),
            "vertex 1",
        ),
        ("text.stl", "hello".into(), "not a readable STL"),
        ("cube.step", String::new(), ".obj, .ply and .stl"),
    ];
    let folder = tempfile::tempdir().unwrap();
    for (name, text, expected) in files {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        let message = Mesh::load(&path).unwrap_err();
        assert!(
            message.contains(name) && message.contains(expected),
            "{name}: {message}"
        );
    }

    let binary = &tetrahedron_files(folder.path())[2];
    let mut bytes = fs::read(binary).unwrap();
    let second = bytes.len() - 4 * 13 - 3 * 12;
    bytes[second..second + 4].copy_from_slice(&f32::NAN.to_le_bytes());
    fs::write(binary, bytes).unwrap();
    let message = Mesh::load(binary).unwrap_err();
    assert!(message.contains("vertex 1 is at [NaN"), "{message}");

    let message = Mesh::load(&folder.path().join("absent.stl")).unwrap_err();
    assert!(message.contains("absent.stl"), "{message}");
}

#[test]
fn holes_are_counted() {
    let mut mesh = cube(DVec3::ZERO, DVec3::ONE);
    assert_eq!(mesh.open_edges(), 0);
    mesh.triangles.pop();
    assert_eq!(mesh.open_edges(), 3);
}

#[test]
fn faces_are_turned_outward() {
    let outward = ball(DVec3::ONE, 0.5, 2);
    let volume = outward.signed_volume();
    assert!(volume > 0.0);

    let mut inward = outward.clone();
    inward.triangles.iter_mut().for_each(|t| t.swap(0, 1));
    assert!((inward.signed_volume() + volume).abs() < 1e-12);
    assert!((inward.oriented().signed_volume() - volume).abs() < 1e-12);

    let mut mixed = outward.clone();
    mixed.triangles.iter_mut().step_by(3).for_each(|t| t.swap(0, 1));
    assert!(mixed.open_edges() > 0);
    let mixed = mixed.oriented();
    assert_eq!(mixed.open_edges(), 0);
    assert!((mixed.signed_volume() - volume).abs() < 1e-12);
}

#[test]
fn an_inner_shell_bounds_a_cavity_and_overlapping_parts_are_one() {
    let mut hollow = ball(DVec3::ZERO, 1.0, 3);
    let mut shell = ball(DVec3::ZERO, 0.5, 3);
    shell.triangles.iter_mut().for_each(|t| t.swap(0, 1));
    append(&mut hollow, shell);
    let surface = Surface::new(&hollow.oriented());
    assert!(!surface.contains(DVec3::ZERO));
    assert!(surface.contains(DVec3::new(0.0, 0.75, 0.0)));

    let mut union = cube(DVec3::ZERO, DVec3::ONE);
    append(&mut union, cube(DVec3::splat(0.5), DVec3::splat(1.5)));
    let surface = Surface::new(&union);
    for inside in [0.25, 0.75, 1.25] {
        assert!(surface.contains(DVec3::splat(inside)));
    }
    assert!(!surface.contains(DVec3::new(0.25, 1.25, 0.25)));
}

fn append(mesh: &mut Mesh, other: Mesh) {
    let first = mesh.vertices.len() as u32;
    mesh.vertices.extend(other.vertices);
    mesh.triangles
        .extend(other.triangles.iter().map(|t| t.map(|index| first + index)));
}

#[test]
fn placed_scales_then_turns_about_x_y_z_then_moves() {
    let mesh = Mesh {
        vertices: vec![DVec3::X, DVec3::Y],
        triangles: Vec::new(),
    };
    let placed = mesh.placed(
        DVec3::splat(2.0),
        DVec3::new(90.0, 90.0, 0.0),
        DVec3::new(10.0, 0.0, 0.0),
    );
    // x stays under the turn about x and goes to -z about y; y goes to z, then to x.
    assert!(placed.vertices[0].abs_diff_eq(DVec3::new(10.0, 0.0, -2.0), 1e-12));
    assert!(placed.vertices[1].abs_diff_eq(DVec3::new(12.0, 0.0, 0.0), 1e-12));
}

/// Every point of a lattice through the cube's faces, edges, vertices and the diagonals that split its faces.
#[test]
fn inside_a_cube_is_exact_where_lines_meet_edges_and_vertices() {
    let surface = Surface::new(&cube(DVec3::splat(-1.0), DVec3::splat(1.0)));
    let ticks: Vec<f64> = (-6..=6).map(|i| f64::from(i) * 0.25).collect();
    for &x in &ticks {
        for &y in &ticks {
            for &z in &ticks {
                let point = DVec3::new(x, y, z);
                let farthest = point.abs().max_element();
                if farthest != 1.0 {
                    assert_eq!(surface.contains(point), farthest < 1.0, "{point}");
                }
            }
        }
    }
}

/// Lines through the vertices themselves, where a careless ray counts two crossings or none.
#[test]
fn inside_holds_along_lines_through_vertices() {
    for mesh in [
        ball(DVec3::ZERO, 1.0, 4),
        torus(1.0, 0.4, 24, 16),
        cube(-DVec3::ONE, DVec3::ONE),
    ] {
        let surface = Surface::new(&mesh);
        let (low, high) = mesh.bounds();
        for vertex in &mesh.vertices {
            let line = surface.line(vertex.y, vertex.z);
            assert!(!line.contains(low.x - 1e-9) && !line.contains(high.x + 1e-9));
        }
    }
    let surface = Surface::new(&ball(DVec3::ZERO, 1.0, 4));
    for vertex in ball(DVec3::ZERO, 1.0, 4).vertices {
        // Toward the middle along the line, and outward from the vertex.
        assert!(surface.contains(vertex.with_x(0.0)) || vertex.with_x(0.0).length() > 0.99);
        assert!(!surface.contains(vertex * 1.001), "{vertex}");
        assert!(surface.contains(vertex * 0.99), "{vertex}");
    }
}

#[test]
fn inside_agrees_with_the_sphere_and_the_torus() {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let sphere = Surface::new(&ball(DVec3::ZERO, 1.0, 5));
    let ring = Surface::new(&torus(1.0, 0.4, 128, 64));
    let (mut decided, mut inside) = (0, 0);
    for _ in 0..20_000 {
        let mut draw = || rng.random::<f64>() * 3.0 - 1.5;
        let point = DVec3::new(draw(), draw(), draw());
        let from_ring = (point.with_y(0.0).length() - 1.0).hypot(point.y) - 0.4;
        for (surface, distance) in [(&sphere, point.length() - 1.0), (&ring, from_ring)] {
            // Flat triangles lie up to 2e-3 below the round surface.
            if !(-2e-3..=0.0).contains(&distance) {
                decided += 1;
                inside += usize::from(distance < 0.0);
                assert_eq!(surface.contains(point), distance < 0.0, "{point}");
            }
            assert!((surface.distance(point, 9.0) - distance.abs()).abs() < 2e-3);
            assert!((surface.distance(point, 0.1) - distance.abs().min(0.1)).abs() < 2e-3);
        }
    }
    assert!(decided > 39_000 && inside > 5_000);
}

#[test]
fn the_bunny_is_closed_and_stands_on_the_floor() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/meshes/bunny.obj");
    let mesh = Mesh::load(&path).unwrap();
    assert_eq!(mesh.open_edges(), 0);
    assert_eq!(mesh.vertices.len(), 1839);
    let (low, high) = mesh.bounds();
    assert_eq!((low.y, high.y), (0.0, 1.0));
    assert!((low + high).with_y(0.0).abs().max_element() < 1e-5);
    // Of the package's own coordinates, which are 9.657897 high: 194.28837.
    let volume = mesh.signed_volume();
    assert!(
        (volume - 194.28837 / 9.657897f64.powi(3)).abs() < 1e-5,
        "{volume}"
    );
    assert!(Surface::new(&mesh).contains(DVec3::new(0.0, 0.3, 0.0)));
}
