//! Every neighbor search against brute force: every neighbor found, none twice, none missing.

use glam::Vec3;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sliceflow::gpu::device::Limits;
use sliceflow::neighbors::{ADDRESSINGS, STORAGES};
use sliceflow::plan::{Plan, Wanted};
use sliceflow::scene::Scene;
use sliceflow::simulation::Simulation;

use crate::common;

/// Every addressing with every storage, by name.
fn grids() -> Vec<(&'static str, &'static str)> {
    let storages = |addressing| STORAGES.iter().map(move |storage| (addressing, storage.name));
    ADDRESSINGS
        .iter()
        .flat_map(|addressing| storages(addressing.name))
        .collect()
}

/// Every addressing with one storage, by name.
fn in_turn(shift: usize) -> Vec<(&'static str, &'static str)> {
    let grids = common::grids_in_turn(shift).into_iter();
    grids
        .map(|(addressing, storage)| (addressing.name, storage.name))
        .collect()
}

/// The scene of the tests with these particles at rest and open sides, through one grid and without lists.
fn scene_of(dimensions: usize, grid: (&str, &str), axis: &str, slots: usize, points: &[Vec3]) -> Scene {
    scene_with(dimensions, grid, axis, slots, points, &[])
}

fn scene_with(
    dimensions: usize,
    grid: (&str, &str),
    axis: &str,
    slots: usize,
    points: &[Vec3],
    more: &[&str],
) -> Scene {
    let choices = [
        format!("neighbors.addressing={}", grid.0),
        format!("neighbors.storage={}", grid.1),
        format!("neighbors.slicing_axis={axis}"),
        format!("neighbors.slots={slots}"),
        "domain.walls=open".into(),
        "domain.sides={}".into(),
        "colliders=[]".into(),
        "neighbors.skin=0".into(),
    ];
    let all: Vec<&str> = choices
        .iter()
        .map(String::as_str)
        .chain(more.iter().copied())
        .collect();
    common::resting(common::scene(dimensions, &all), points)
}

/// All pairs by the one predicate: strictly nearer than the radius, in f32.
fn brute_force(points: &[Vec3], radius: f32) -> (Vec<u64>, Vec<u32>) {
    let mut start = vec![0];
    let mut ids = Vec::new();
    for (i, a) in points.iter().enumerate() {
        for (j, b) in points.iter().enumerate() {
            if i != j && (*b - *a).length_squared() < radius * radius {
                ids.push(j as u32);
            }
        }
        start.push(ids.len() as u64);
    }
    (start, ids)
}

/// Compares grids, with storages in turn, and slicing axes on a point set.
fn check(what: &str, dimensions: usize, points: &[Vec3]) {
    let axes = &["y", "x", "z"][..dimensions];
    for (addressing, storage) in common::grids_in_turn(0) {
        let turns = common::has_slices(addressing);
        for axis in &axes[..if turns { dimensions } else { 1 }] {
            check_grid(what, dimensions, points, (addressing.name, storage.name), axis);
        }
    }
}

fn check_grid(what: &str, dimensions: usize, points: &[Vec3], grid: (&str, &str), axis: &str) {
    // Room for everybody: overflow has a test of its own.
    let scene = scene_of(dimensions, grid, axis, 64, points);
    check_scene(&format!("{what}, {dimensions}D, {grid:?}, axis {axis}"), &scene);
}

fn check_scene(label: &str, scene: &Scene) {
    let points = &scene.particles.position;
    let mut simulation = common::simulate(scene, &Wanted::default());
    simulation.next_frame().expect("the first search");
    let found = simulation.neighbor_lists().expect("neighbors");
    let (start, ids) = brute_force(points, (2.0 * scene.radius()) as f32);
    assert_eq!(found.start, start, "{label}: numbers of neighbors");
    assert_eq!(found.ids, ids, "{label}: neighbors");
}

/// Lower and upper corner of the test scene's domain, which has negative coordinates.
fn corners(dimensions: usize) -> (Vec3, Vec3, f32) {
    let scene = common::scene(dimensions, &[]);
    (scene.domain.min, scene.domain.max, (2.0 * scene.radius()) as f32)
}

fn random(dimensions: usize, count: usize, seed: u64) -> Vec<Vec3> {
    let (min, max, _) = corners(dimensions);
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut unit = || Vec3::new(rng.random(), rng.random(), rng.random());
    (0..count).map(|_| min + (max - min) * unit()).collect()
}

#[test]
fn random_points() {
    let points = random(3, 2000, 1);
    check("random", 3, &points);
    for grid in grids() {
        check_grid("random", 3, &points, grid, "y");
    }
    check("random", 2, &random(2, 1500, 2));
}

#[test]
fn voxels_of_half_the_radius() {
    for dimensions in [2, 3] {
        let points = random(dimensions, 1200, 9);
        for grid in in_turn(dimensions) {
            let scene = scene_with(dimensions, grid, "y", 64, &points, &["neighbors.cell=half"]);
            check_scene(&format!("half, {dimensions}D, {grid:?}"), &scene);
        }
    }
}

#[test]
fn lists_with_a_skin() {
    // What is on lists depends on distances alone, so two grids are enough in 2D.
    for (dimensions, most) in [(2, 2), (3, usize::MAX)] {
        let points = random(dimensions, 1200, 13);
        for grid in in_turn(dimensions).into_iter().take(most) {
            for skin in ["0.1", "1"] {
                let skin = format!("neighbors.skin={skin}");
                let scene = scene_with(dimensions, grid, "y", 64, &points, &[&skin]);
                check_scene(&format!("{skin}, {dimensions}D, {grid:?}"), &scene);
            }
        }
    }
}

#[test]
fn clusters_in_regions_of_their_own() {
    // Regions are found before storages see anything.
    let mut storages = STORAGES.iter().cycle();
    for dimensions in [2, 3] {
        let (min, max, reach) = corners(dimensions);
        let flat = if dimensions == 2 {
            Vec3::new(1.0, 1.0, 0.0)
        } else {
            Vec3::ONE
        };
        let mut rng = ChaCha8Rng::seed_from_u64(12);
        // Clusters in all corners, some so near to each other that they stay together.
        let points: Vec<Vec3> = (0..900)
            .map(|i| {
                let along = |k: usize| [0.0, 0.05, 1.0][k % 3];
                let cluster = Vec3::new(along(i), along(i / 3), along(i / 9));
                let unit = Vec3::new(rng.random(), rng.random(), rng.random());
                (min + (max - min) * cluster + 3.0 * reach * unit) * flat
            })
            .collect();
        for (axis, storage) in ["x", "y", "z"][..dimensions].iter().zip(storages.by_ref()) {
            let with = |regions| {
                let regions = format!("neighbors.regions={regions}");
                scene_with(
                    dimensions,
                    ("sliced", storage.name),
                    axis,
                    64,
                    &points,
                    &[&regions, "neighbors.margin=1"],
                )
            };
            let (apart, together) = (with(true), with(false));
            check_scene(
                &format!("regions, {dimensions}D, {}, axis {axis}", storage.name),
                &apart,
            );
            let voxels = |scene: &Scene| {
                let wanted = Wanted {
                    statistics: true,
                    ..Default::default()
                };
                let mut simulation = common::simulate(scene, &wanted);
                simulation.next_frame().unwrap();
                let frame = simulation.finish_frame().unwrap().unwrap();
                assert_eq!(frame.reallocations, 0, "the host counted too little");
                frame.statistics.unwrap().voxels_allocated
            };
            let (apart_voxels, together_voxels) = (voxels(&apart), voxels(&together));
            assert!(
                apart_voxels < together_voxels,
                "{dimensions}D, axis {axis}: {apart_voxels} voxels in regions, {together_voxels} without"
            );
            let counted = sliceflow::neighbors::first_grid(&apart).capacity;
            assert!(
                counted >= apart_voxels && counted <= apart_voxels.max(1024),
                "{counted} {apart_voxels}"
            );
        }
    }
}

#[test]
fn clusters_sheets_and_lines() {
    let (min, max, reach) = corners(3);
    let mut rng = ChaCha8Rng::seed_from_u64(10);
    let mut unit = || Vec3::new(rng.random(), rng.random(), rng.random());
    let corner = max - Vec3::splat(3.0 * reach);
    let clusters = (0..600)
        .map(|i| if i % 2 == 0 { min } else { corner } + 3.0 * reach * unit())
        .collect::<Vec<_>>();
    check("clusters", 3, &clusters);
    let sheet = random(3, 900, 11)
        .iter()
        .map(|p| Vec3::new(p.x, 0.01 * p.y, p.z))
        .collect::<Vec<_>>();
    check("sheet", 3, &sheet);
    let line = (0..300)
        .map(|i| min + (max - min) * (i as f32 / 299.0))
        .collect::<Vec<_>>();
    check("line", 3, &line);
}

#[test]
fn few_points() {
    for dimensions in [2, 3] {
        let (min, max, reach) = corners(dimensions);
        check("one", dimensions, &[min]);
        check("two apart", dimensions, &[min, max]);
        check("two together", dimensions, &[max - Vec3::X * 0.5 * reach, max]);
    }
}

#[test]
fn lattice_with_neighbors_at_exactly_the_radius_and_on_voxel_borders() {
    for dimensions in [2, 3] {
        let (min, _, reach) = corners(dimensions);
        let grid = sliceflow::neighbors::first_grid(&common::scene(dimensions, &[]));
        let depth = if dimensions == 2 { 1 } else { 6 };
        // Multiples of the radius lie around the origin, where some pairs are exactly as far apart in f32.
        for (first, step) in [
            (Vec3::new(-4.0, -4.0, -(depth / 2) as f32) * reach, reach),
            (min, grid.side),
        ] {
            let mut points = Vec::new();
            for x in 0..8 {
                for y in 0..8 {
                    for z in 0..depth {
                        points.push(first + Vec3::new(x as f32, y as f32, z as f32) * step);
                    }
                }
            }
            check("lattice", dimensions, &points);
            // Also one unit in the last place to either side of each voxel face.
            let nudged = |nudge: fn(f32) -> f32| {
                let flat = dimensions == 2;
                points.iter().map(move |p| {
                    let z = if flat { p.z } else { nudge(p.z) };
                    Vec3::new(nudge(p.x), nudge(p.y), z)
                })
            };
            let all: Vec<Vec3> = nudged(f32::next_up)
                .chain(points.iter().copied())
                .chain(nudged(f32::next_down))
                .collect();
            check("lattice and its neighbors in f32", dimensions, &all);
        }
    }
}

#[test]
fn everybody_in_one_voxel_or_at_one_point() {
    for dimensions in [2, 3] {
        let (min, _, reach) = corners(dimensions);
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let one_voxel: Vec<Vec3> = (0..60)
            .map(|_| {
                min + reach
                    * 0.9
                    * Vec3::new(
                        rng.random(),
                        rng.random(),
                        if dimensions == 3 { rng.random() } else { 0.0 },
                    )
            })
            .collect();
        check("one voxel, the first", dimensions, &one_voxel);
        check("coincident", dimensions, &[min + Vec3::X * reach; 50]);
    }
}

#[test]
fn points_beyond_the_domain() {
    // Open sides let grains leave; they belong to border voxels and lose no neighbor.
    for dimensions in [2, 3] {
        let flat = if dimensions == 2 {
            Vec3::new(1.0, 1.0, 0.0)
        } else {
            Vec3::ONE
        };
        let points: Vec<Vec3> = random(dimensions, 900, 4)
            .iter()
            .map(|p| *p * 1.6 * flat)
            .collect();
        check("beyond", dimensions, &points);
    }
}

#[test]
fn a_pool_reports_what_it_has_no_room_for() {
    let (min, _, reach) = corners(3);
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let mut points: Vec<Vec3> = (0..11)
        .map(|_| min + reach * 0.9 * Vec3::new(rng.random(), rng.random(), rng.random()))
        .collect();
    points.push(min + Vec3::ONE * 10.0 * reach);
    // tests/library/occupancy.rs has a pool that overflows through every addressing.
    for addressing in ["sliced", "hash"] {
        let scene = scene_of(3, (addressing, "pool"), "y", 4, &points);
        let mut simulation = common::simulate(
            &scene,
            &Wanted {
                statistics: true,
                ..Default::default()
            },
        );
        simulation.next_frame().unwrap();
        let frame = simulation.finish_frame().unwrap().unwrap();
        assert_eq!(frame.overflow, 7);
        let statistics = frame.statistics.unwrap();
        assert_eq!(statistics.overflow, 7);
        assert_eq!(statistics.voxels_with_more, 1);
        assert_eq!(statistics.voxels_with, [1, 0, 0, 0]);
        assert_eq!(statistics.voxels_occupied, 2);
        let found = simulation.neighbor_lists().unwrap();
        // The four lowest ids have the slots; they see each other, whatever order the atomics had.
        assert!(found.ids.iter().all(|&id| id < 4), "{:?}", found.ids);
    }
}

#[test]
fn sliced_allocates_the_bounding_box_of_each_slice() {
    // Harada 2007, Eq. 1 to 3, on the host.
    let points = random(3, 300, 6);
    let scene = scene_of(3, ("sliced", "pool"), "y", 4, &points);
    let grid = sliceflow::neighbors::first_grid(&scene);
    let mut boxes = std::collections::BTreeMap::new();
    for p in &points {
        let voxel = |axis: usize| ((p[axis] - grid.lower[axis]) * grid.inverse_side).floor() as i32;
        let entry = boxes
            .entry(voxel(1))
            .or_insert([i32::MAX, i32::MAX, i32::MIN, i32::MIN]);
        *entry = [
            entry[0].min(voxel(0)),
            entry[1].min(voxel(2)),
            entry[2].max(voxel(0)),
            entry[3].max(voxel(2)),
        ];
    }
    let expected: i32 = boxes
        .values()
        .map(|b| (b[2] - b[0] + 1) * (b[3] - b[1] + 1))
        .sum();
    let mut simulation = common::simulate(
        &scene,
        &Wanted {
            statistics: true,
            ..Default::default()
        },
    );
    simulation.next_frame().unwrap();
    let statistics = simulation.finish_frame().unwrap().unwrap().statistics.unwrap();
    assert_eq!(statistics.voxels_allocated, expected as u32);
    assert!(statistics.voxels_allocated < grid.capacity);
}

#[test]
fn folded_dispatches_do_the_same_work() {
    // Eight groups of a dispatch in one dimension, instead of 65,535.
    let points = random(3, 3000, 7);
    for grid in in_turn(0) {
        let scene = scene_of(3, grid, "y", 64, &points);
        let mut gpu = common::gpu();
        gpu.limits.groups = 8;
        let plan = Plan::new(&scene, &gpu.limits, &Wanted::default()).unwrap();
        let mut folded = Simulation::new(gpu, &scene, &plan).unwrap();
        folded.next_frame().unwrap();
        let (start, ids) = brute_force(&points, (2.0 * scene.radius()) as f32);
        let found = folded.neighbor_lists().unwrap();
        assert!(found.start == start && found.ids == ids, "{grid:?}");
    }
}

#[test]
fn particles_of_a_voxel_stand_in_canonical_order() {
    // Many particles in few voxels, so that threads race for the counters: whatever order they arrive in, those of a
    // voxel must stand in the order that they had before, here that of their ids.
    let (min, _, reach) = corners(3);
    let mut rng = ChaCha8Rng::seed_from_u64(8);
    let points: Vec<Vec3> = (0..4000)
        .map(|_| min + 3.9 * reach * Vec3::new(rng.random(), rng.random(), rng.random()))
        .collect();
    let sorting = STORAGES.iter().filter(|row| row.sorts).cycle();
    for (addressing, storage) in ADDRESSINGS.iter().zip(sorting) {
        let name = (addressing.name, storage.name);
        let scene = scene_of(3, name, "y", 4, &points);
        let grid = sliceflow::neighbors::first_grid(&scene);
        let voxel = |id: u32| {
            let p = points[id as usize];
            [0, 1, 2].map(|axis| ((p[axis] - grid.lower[axis]) * grid.inverse_side).floor() as i32)
        };
        for _ in 0..5 {
            let mut simulation = common::simulate(&scene, &Wanted::default());
            simulation.next_frame().unwrap();
            let buffer = simulation.buffers().get("id", "(test)").unwrap();
            let ids: Vec<u32> =
                sliceflow::gpu::readback::read(simulation.gpu(), buffer, points.len()).unwrap();
            for pair in ids.windows(2) {
                assert!(
                    voxel(pair[0]) != voxel(pair[1]) || pair[0] < pair[1],
                    "{name:?}: {pair:?}"
                );
            }
        }
    }
}

#[test]
fn without_a_canonical_order_neighbors_are_the_same() {
    let points = random(3, 3000, 9);
    for grid in grids() {
        let mut scene = scene_of(3, grid, "y", 64, &points);
        let repeatable = Plan::new(&scene, &Limits::PROMISED, &Wanted::default()).unwrap();
        scene.neighbors.deterministic = false;
        let plan = Plan::new(&scene, &Limits::PROMISED, &Wanted::default()).unwrap();
        let saved = |count: fn(&Plan) -> usize| count(&repeatable) - count(&plan);
        let saved = (saved(|plan| plan.passes.len()), saved(|plan| plan.buffers.len()));
        // The scatter, at the start and in steps, and its buffer.
        assert_eq!(
            saved,
            if grid.1 == "counting" { (2, 1) } else { (0, 0) },
            "{grid:?}"
        );
        let noted = plan
            .notes
            .iter()
            .any(|note| note.contains("neighbors.deterministic"));
        assert_eq!(noted, ["radix", "bitonic"].contains(&grid.1), "{grid:?}");

        if !in_turn(0).contains(&grid) {
            continue;
        }
        let mut simulation = common::simulate(&scene, &Wanted::default());
        simulation.next_frame().unwrap();
        let found = simulation.neighbor_lists().unwrap();
        let (start, ids) = brute_force(&points, (2.0 * scene.radius()) as f32);
        assert!(found.start == start && found.ids == ids, "{grid:?}");
    }
}

#[test]
fn a_pool_without_a_canonical_order_reports_what_it_has_no_room_for() {
    let (min, _, reach) = corners(3);
    let points = vec![min + Vec3::ONE * 0.5 * reach; 11];
    let mut scene = scene_of(3, ("uniform", "pool"), "y", 4, &points);
    scene.neighbors.deterministic = false;
    let mut simulation = common::simulate(&scene, &Wanted::default());
    simulation.next_frame().unwrap();
    assert_eq!(simulation.finish_frame().unwrap().unwrap().overflow, 7);
    // Whoever has the slots: each of the four is seen by the ten others.
    assert_eq!(simulation.neighbor_lists().unwrap().ids.len(), 4 * 10);
}
