//! All pairs of bare points.

mod common;

use glam::DVec3;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sliceflow::gpu::device::Limits;
use sliceflow::neighbors::{ADDRESSINGS, STORAGES};
use sliceflow::plan::{Plan, Wanted};
use sliceflow::scene::{Dimensions, Neighbors, Scene};

/// Points of a cloud of width 1 around `center`, on multiples of 2⁻²⁰, which f64 holds around a million too.
fn cloud(count: usize, dimensions: Dimensions, center: f64) -> Vec<DVec3> {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut coordinate = || f64::from(rng.random_range(0..1 << 20)) / f64::from(1 << 20) - 0.5 + center;
    let mut point = || DVec3::new(coordinate(), coordinate(), coordinate());
    let flat = |p: DVec3| match dimensions {
        Dimensions::Two => p.with_z(0.0),
        Dimensions::Three => p,
    };
    (0..count).map(|_| flat(point())).collect()
}

/// For each point the places of those nearer than the radius, in f64.
fn brute_force(points: &[DVec3], radius: f64) -> Vec<Vec<u32>> {
    let near = |a: &DVec3| {
        let within = |b: &DVec3| (*b - *a).length_squared() < radius * radius;
        let found = points.iter().enumerate().filter(|(_, b)| within(b));
        found
            .filter(|(_, b)| !std::ptr::eq(*b, a))
            .map(|(j, _)| j as u32)
            .collect()
    };
    points.iter().map(near).collect()
}

#[test]
fn bare_points_are_a_scene_that_every_grid_searches() {
    for (dimensions, radius) in [(Dimensions::Two, 0.06), (Dimensions::Three, 0.13)] {
        for center in [0.0, 1e6] {
            let points = cloud(800, dimensions, center);
            let expected = brute_force(&points, radius);
            for addressing in ADDRESSINGS {
                for storage in STORAGES {
                    let neighbors = Neighbors {
                        addressing: addressing.kind,
                        storage: storage.kind,
                        slots: 32,
                        ..Default::default()
                    };
                    let scene = Scene::of_points(&points, dimensions, radius, neighbors).unwrap();
                    let mut simulation = common::simulate(&scene, &Wanted::default());
                    simulation.next_frame().unwrap();
                    let found = simulation.neighbor_lists().unwrap();
                    for (i, ids) in expected.iter().enumerate() {
                        let list = &found.ids[found.start[i] as usize..found.start[i + 1] as usize];
                        let grid = (addressing.name, storage.name);
                        assert_eq!(list, ids, "{grid:?}, {dimensions:?}, around {center}: point {i}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_radius_too_small_for_the_adapter_is_refused_with_a_mend() {
    let points = cloud(100, Dimensions::Three, 0.0);
    let scene = Scene::of_points(&points, Dimensions::Three, 1e-5, Neighbors::default()).unwrap();
    let message = Plan::new(&scene, &Limits::PROMISED, &Wanted::default())
        .unwrap_err()
        .to_string();
    assert!(message.contains("voxels would fit"), "{message}");
    assert!(message.contains("search radius"), "{message}");
}
