use std::f64::consts::PI;
use std::path::Path;

use glam::DVec3;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::super::Dimensions::{Three, Two};
use super::super::mesh::samples::{ball, cube, torus};
use super::*;

fn seeded(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

fn plain(region: &Region, dimensions: Dimensions, radius: f64, spacing: f64) -> Vec<DVec3> {
    lattice(region, dimensions, radius, spacing, 0.0, &mut seeded(0))
}

fn boxed(min: DVec3, max: DVec3) -> Region {
    Region::Box { min, max }
}

/// Metres; negative inside.
type Distance = Box<dyn Fn(DVec3) -> f64>;

/// A region of each kind with its volume and the distance to its surface.
fn regions() -> Vec<(Region, f64, Distance)> {
    let center = DVec3::new(3.0, -1.0, 0.5);
    let (from, to) = (DVec3::new(-1.0, 0.0, 0.0), DVec3::new(1.0, 1.0, 1.0));
    vec![
        (
            boxed(center - 0.8, center + 0.7),
            1.5f64.powi(3),
            Box::new(move |p| ((p - center + 0.05).abs() - 0.75).max_element()),
        ),
        (
            Region::Sphere { center, radius: 1.0 },
            4.0 / 3.0 * PI,
            Box::new(move |p| p.distance(center) - 1.0),
        ),
        (
            Region::Cylinder {
                from,
                to,
                radius: 0.8,
            },
            PI * 0.64 * from.distance(to),
            Box::new(move |p| {
                let along = (to - from).normalize();
                let height = (p - from).dot(along);
                let aside = (p - from).cross(along).length();
                (aside - 0.8).max(-height).max(height - from.distance(to))
            }),
        ),
        (
            Region::Mesh(torus(1.0, 0.5, 200, 100)),
            2.0 * PI * PI * 0.25,
            Box::new(|p| (p.with_y(0.0).length() - 1.0).hypot(p.y) - 0.5),
        ),
    ]
}

fn closest_pair(points: &[DVec3]) -> f64 {
    let mut nearest = f64::INFINITY;
    for (index, a) in points.iter().enumerate() {
        for b in &points[..index] {
            nearest = nearest.min(a.distance(*b));
        }
    }
    nearest
}

#[test]
fn a_box_holds_as_many_grains_as_its_sides_say() {
    let region = boxed(DVec3::ZERO, DVec3::ONE);
    let points = plain(&region, Three, 0.05, 0.1);
    assert_eq!(points.len(), 1000);
    assert_eq!(points[0], DVec3::splat(0.05));
    assert!(points[999].abs_diff_eq(DVec3::splat(0.95), 1e-12));
    assert_eq!(plain(&region, Two, 0.05, 0.1).len(), 100);

    // Divisions that do not come out even in binary, near zero and far away.
    for parts in 1..200u32 {
        for start in [0.0, -0.3, 1e3, -123_456.7, 1e6] {
            let spacing = 0.7 / f64::from(parts);
            let min = DVec3::new(start, 0.0, 0.0);
            let max = DVec3::new(start + 0.7, spacing, 0.0);
            let count = plain(&boxed(min, max), Two, spacing / 2.0, spacing).len();
            assert_eq!(count, parts as usize, "{parts} from {start}");
        }
    }
    // A hair too small is too small.
    assert_eq!(
        plain(&boxed(DVec3::ZERO, DVec3::splat(1.0 - 1e-6)), Three, 0.05, 0.1).len(),
        729
    );
    assert!(plain(&boxed(DVec3::ZERO, DVec3::splat(0.09)), Three, 0.05, 0.1).is_empty());
}

#[test]
fn x_runs_fastest_then_z_then_y() {
    let points = plain(&boxed(DVec3::ZERO, DVec3::splat(2.0)), Three, 0.5, 1.0);
    let order: Vec<_> = points.iter().map(|p| (p.y, p.z, p.x)).collect();
    assert_eq!(order.len(), 8);
    assert!(order.is_sorted());
}

#[test]
fn a_sphere_has_a_grain_in_its_center_and_a_mesh_leaves_equal_room() {
    let sphere = Region::Sphere {
        center: DVec3::new(0.3, 0.2, 9.0),
        radius: 0.3,
    };
    // The center and its six neighbors; a disc, in 2D, and its four.
    let points = plain(&sphere, Three, 0.1, 0.2);
    assert_eq!(points.len(), 7);
    assert!(points.contains(&DVec3::new(0.3, 0.2, 9.0)));
    let disc = plain(&sphere, Two, 0.1, 0.2);
    assert_eq!(disc.len(), 5);
    assert!(disc.contains(&DVec3::new(0.3, 0.2, 0.0)));

    for (size, place) in [(0.3, 0.1), (1.0, 0.1), (1.04, 0.1), (1.04, 1e6)] {
        let mesh = Region::Mesh(cube(DVec3::splat(place), DVec3::splat(place + size)));
        let points = plain(&mesh, Three, 0.05, 0.1);
        assert_eq!(points.len(), ((size * 10.0 + 0.1) as usize).pow(3));
        let middle = points.iter().sum::<DVec3>() / points.len() as f64;
        assert!(middle.abs_diff_eq(DVec3::splat(place + size / 2.0), 1e-6));
    }

    let upright = Region::Cylinder {
        from: DVec3::ZERO,
        to: DVec3::Y,
        radius: 0.2,
    };
    let heights = plain(&upright, Three, 0.05, 0.1);
    assert_eq!(
        heights
            .iter()
            .filter(|p| p.x == heights[0].x && p.z == heights[0].z)
            .count(),
        10
    );
}

#[test]
fn lattices_fill_the_volume_and_every_grain_is_wholly_inside() {
    let spacing = 0.03;
    for (region, volume, distance) in regions() {
        let points = plain(&region, Three, 1e-6, spacing);
        let filled = points.len() as f64 * spacing.powi(3);
        assert!((filled / volume - 1.0).abs() < 0.02, "{filled} of {volume}");

        let radius = 0.2;
        let points = plain(&region, Three, radius, spacing);
        let worst = points.iter().map(|&p| distance(p)).fold(-1.0, f64::max);
        // Up to the torus' facets, which lie 1e-3 below the round surface.
        assert!(worst < -radius + 1e-9, "{worst}");
        assert!(worst > -radius - 0.01, "{worst}");
    }
}

#[test]
fn cylinders_and_meshes_hold_nothing_in_2d() {
    for (region, _, _) in regions().drain(2..) {
        assert!(plain(&region, Two, 0.01, 0.05).is_empty());
        assert!(random(&region, Two, 0.01, 0.2, &mut seeded(0)).is_empty());
    }
}

#[test]
fn jitter_displaces_by_its_share_and_stays_inside() {
    let (spacing, jitter) = (0.04, 0.3);
    for (region, _, distance) in regions() {
        let still = plain(&region, Three, 0.01, spacing);
        let draw = |seed| lattice(&region, Three, 0.01, spacing, jitter, &mut seeded(seed));
        let moved = draw(1);
        assert_eq!(moved.len(), still.len());
        let mut displacement = 0.0;
        for (a, b) in still.iter().zip(&moved) {
            assert!((a - b).abs().max_element() <= jitter * spacing);
            assert!(distance(*b) <= -0.01 + 1e-6);
            displacement += (a - b).abs().element_sum() / (3.0 * spacing * still.len() as f64);
        }
        // The mean of |u| is jitter / 2; some at the surface stay where they are.
        assert!(
            (0.3 * jitter..0.52 * jitter).contains(&displacement),
            "{displacement}"
        );
        assert_eq!(moved, draw(1));
        assert_ne!(moved, draw(2));
    }
    let flat = lattice(
        &boxed(DVec3::ZERO, DVec3::ONE),
        Two,
        0.01,
        0.1,
        0.5,
        &mut seeded(1),
    );
    assert!(flat.iter().all(|point| point.z == 0.0));
}

#[test]
fn random_grains_reach_the_fraction_without_overlap() {
    let radius = 0.06;
    for (region, volume, distance) in regions() {
        let points = random(&region, Three, radius, 0.2, &mut seeded(5));
        let grains = points.len() as f64 * 4.0 / 3.0 * PI * radius.powi(3);
        assert!(grains <= 0.2 * volume + 1e-9);
        assert!(grains > 0.19 * volume, "{grains} of {volume}");
        assert!(closest_pair(&points) >= 2.0 * radius);
        assert!(points.iter().all(|&p| distance(p) <= -radius + 1e-6));
        assert_eq!(points, random(&region, Three, radius, 0.2, &mut seeded(5)));
        assert_ne!(points, random(&region, Three, radius, 0.2, &mut seeded(6)));
    }
}

#[test]
fn random_gives_what_fits() {
    let square = boxed(DVec3::ZERO, DVec3::ONE);
    let discs = random(&square, Two, 0.02, 0.5, &mut seeded(1));
    assert!(closest_pair(&discs) >= 0.04);
    assert!(discs.iter().all(|p| p.z == 0.0));
    let share = discs.len() as f64 * PI * 0.02 * 0.02;
    assert!((0.44..=0.5).contains(&share), "{share}");

    let grains = random(&square, Three, 0.04, 0.5, &mut seeded(1));
    assert!(closest_pair(&grains) >= 0.08);
    let share = grains.len() as f64 * 4.0 / 3.0 * PI * 0.04f64.powi(3);
    assert!((0.28..0.384).contains(&share), "{share}");

    let too_large = Region::Mesh(ball(DVec3::ZERO, 0.1, 2));
    assert!(random(&too_large, Three, 0.2, 0.5, &mut seeded(1)).is_empty());
    assert!(plain(&too_large, Three, 0.2, 0.4).is_empty());
    assert_eq!(
        random(&boxed(DVec3::ZERO, DVec3::ONE), Three, 0.5, 0.53, &mut seeded(1)).len(),
        1
    );
}

#[test]
fn without_overlaps_agrees_with_brute_force() {
    let mut rng = seeded(3);
    for (count, distance, flat) in [(3000, 0.1, false), (3000, 0.03, true), (500, 5.0, false)] {
        let points: Vec<DVec3> = (0..count)
            .map(|_| {
                let z = if flat { 0.0 } else { rng.random::<f64>() };
                DVec3::new(rng.random(), rng.random(), z) * 2.0 - 1.0
            })
            .collect();
        let mut expected: Vec<usize> = Vec::new();
        for (index, point) in points.iter().enumerate() {
            let near = |&other: &usize| points[other].distance(*point) < distance * (1.0 - 1e-6);
            if !expected.iter().any(near) {
                expected.push(index);
            }
        }
        assert!(expected.len() < count);
        assert_eq!(without_overlaps(&points, distance), expected);
    }
}

#[test]
fn grains_that_touch_do_not_overlap() {
    let points = plain(&boxed(DVec3::splat(-1.0), DVec3::ONE), Three, 0.05, 0.1);
    assert_eq!(without_overlaps(&points, 0.1).len(), 8000);
    assert_eq!(without_overlaps(&points, 0.1 * (1.0 + 1e-5)).len(), 8000 / 2);
}

/// The bunny with each facet split in sixteen: about as many as the Stanford scan has.
#[test]
fn a_bunny_of_59_thousand_triangles_is_filled() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/meshes/bunny.obj");
    let mut bunny = Mesh::load(&path).unwrap();
    for _ in 0..2 {
        let mut finer = Mesh::default();
        for triangle in &bunny.triangles {
            let [a, b, c] = triangle.map(|index| bunny.vertices[index as usize]);
            let [ab, bc, ca] = [(a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0];
            for corners in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
                let first = finer.vertices.len() as u32;
                finer.vertices.extend(corners);
                finer.triangles.push([first, first + 1, first + 2]);
            }
        }
        bunny = finer;
    }
    assert_eq!(bunny.triangles.len(), 58_784);
    let (volume, spacing) = (bunny.signed_volume(), 0.0125);
    let points = plain(&Region::Mesh(bunny), Three, 0.1 * spacing, spacing);
    let filled = points.len() as f64 * spacing.powi(3);
    assert!((0.93..1.0).contains(&(filled / volume)), "{filled} of {volume}");
    assert!(points.len() > 90_000, "{}", points.len());
}
