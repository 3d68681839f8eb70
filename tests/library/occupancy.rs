//! Voxels counted on the host against brute force, and against what every search has on the device.

use std::collections::{BTreeMap, BTreeSet};

use glam::Vec3;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sliceflow::gpu::BufferPlan;
use sliceflow::neighbors::occupancy::{Allocation, Census, Figures, hash_buckets};
use sliceflow::neighbors::{ADDRESSINGS, Grid, STORAGES};
use sliceflow::plan::{Plan, Wanted};
use sliceflow::scene::{Dimensions, Scene};

use crate::common;

fn scene_of(dimensions: usize, axis: &str, points: &[Vec3]) -> Scene {
    let axis = format!("neighbors.slicing_axis={axis}");
    let scene = common::scene(
        dimensions,
        &[&axis, "colliders=[]", "neighbors.slots=2", "neighbors.skin=0"],
    );
    common::resting(scene, points)
}

/// Points all over the domain and a little beyond, and three dense clouds.
fn points(dimensions: usize, seed: u64) -> Vec<Vec3> {
    let domain = common::scene(dimensions, &[]).domain;
    let size = domain.max - domain.min;
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut unit = || Vec3::new(rng.random(), rng.random(), rng.random());
    let flat = Vec3::new(1.0, 1.0, (dimensions - 2) as f32);
    let mut points: Vec<Vec3> = (0..200)
        .map(|_| domain.min + size * (1.1 * unit() - 0.05) * flat)
        .collect();
    for _ in 0..3 {
        let center = domain.min + size * unit();
        points.extend((0..150).map(|_| center + 0.1 * size * unit() * flat));
    }
    points
}

fn axes(dimensions: usize) -> &'static [&'static str] {
    &["x", "y", "z"][..dimensions]
}

/// Particles of each voxel; those beyond the domain in voxels of their own, or at its border.
fn counted(grid: &Grid, axis: &str, at_border: bool, points: &[Vec3]) -> BTreeMap<[i32; 3], u32> {
    let order = match axis {
        "x" => [1, 0, 2],
        "y" => [0, 1, 2],
        _ => [0, 2, 1],
    };
    let mut counts = BTreeMap::new();
    for p in points {
        let mut voxel = [0; 3];
        for (i, &along) in order.iter().enumerate() {
            let scaled = (p[along] - grid.lower[i]) * grid.inverse_side;
            voxel[i] = scaled.floor() as i32;
            if at_border || grid.size[i] == 1 {
                voxel[i] = voxel[i].max(0).min(grid.size[i] - 1);
            }
        }
        // Closed sides let a search follow no farther than two voxels beyond.
        if (0..3).all(|i| (grid.low[i]..grid.high[i]).contains(&voxel[i])) || at_border {
            *counts.entry(voxel).or_insert(0) += 1;
        }
    }
    counts
}

#[test]
fn voxels_and_slices_are_those_of_brute_force() {
    for (dimensions, addressing) in [(2, "sliced"), (3, "sliced"), (3, "uniform")] {
        for axis in axes(dimensions) {
            let points = points(dimensions, 1);
            let mut scene = scene_of(dimensions, axis, &points);
            let row = ADDRESSINGS.iter().find(|row| row.name == addressing);
            scene.neighbors.addressing = row.unwrap().kind;
            let census = Census::of(&scene, &points);
            let counts = counted(&census.grid, axis, addressing == "uniform", &points);
            let found: BTreeMap<_, _> = census.voxels.iter().map(|v| (v.at, v.particles)).collect();
            assert_eq!(found, counts, "{dimensions}D, {addressing}, axis {axis}");
            let domain = census.grid.size[1];
            let beyond = counts.keys().any(|at| at[1] < 0 || at[1] >= domain);
            assert_eq!(
                beyond,
                addressing == "sliced",
                "some points lie beyond the domain"
            );

            let figures = census.figures();
            let with = |n: u32| counts.values().filter(|&&count| count == n).count() as u64;
            assert_eq!(figures.with, [1, 2, 3, 4].map(with));
            assert!(figures.with_more > 0, "the clouds are dense");
            assert_eq!(
                figures.with_more,
                counts.values().filter(|&&n| n > 4).count() as u64
            );
            let quarantined = u64::from(census.quarantined);
            assert_eq!(figures.particles + quarantined, points.len() as u64);
            assert_eq!(figures.occupied, counts.len() as u64);

            let slices = census.slices();
            for s in 0..domain {
                assert!(slices.iter().any(|slice| slice.at == s), "slice {s}");
            }
            for slice in &slices {
                let of_slice = counts.iter().filter(|(at, _)| at[1] == slice.at);
                let particles: u64 = of_slice.clone().map(|(_, &n)| u64::from(n)).sum();
                assert_eq!(slice.figures.particles, particles);
                assert_eq!(slice.figures.occupied, of_slice.count() as u64);
            }
            let sum =
                |of: fn(&Figures) -> u64| -> u64 { slices.iter().map(|slice| of(&slice.figures)).sum() };
            assert_eq!(sum(|s| s.occupied), figures.occupied);
            assert_eq!(sum(|s| s.with[1]), figures.with[1]);
            assert_eq!(sum(|s| s.with_more), figures.with_more);
        }
    }
}

#[test]
fn octree_has_the_leaves_and_nodes_of_brute_force() {
    for dimensions in [2, 3] {
        let points = points(dimensions, 2);
        let scene = scene_of(dimensions, "y", &points);
        let census = Census::of(&scene, &points);
        let octree = census.octree();
        let counts = counted(&census.grid, "y", false, &points);
        let along = |i: usize| counts.keys().map(move |at| at[i]);
        let low = [0, 1, 2].map(|i| along(i).min().unwrap().min(0));
        let size = [0, 1, 2].map(|i| (along(i).max().unwrap() + 1).max(census.grid.size[i]) - low[i]);
        let mut side = 1;
        while side < size.into_iter().max().unwrap() {
            side *= 2;
        }
        assert_eq!(1 << octree.levels, side);
        // From the root down: a node exists when a particle is in its cube.
        let (mut inner, mut allocated, mut last) = (0, 1, 0);
        let mut cube = side;
        while cube > 1 {
            let node = |at: &[i32; 3]| [0, 1, 2].map(|i| (at[i] - low[i]) / cube);
            let nodes: BTreeSet<_> = counts.keys().map(node).collect();
            inner += nodes.len() as u64;
            last = nodes.len() as u64 * (1 << dimensions);
            allocated += last;
            cube /= 2;
        }
        assert_eq!(octree.leaves, counts.len() as u64);
        assert_eq!(octree.inner, inner);
        assert_eq!(octree.allocated_leaves, last);
        assert_eq!(octree.allocated_nodes(), allocated);
    }
}

#[test]
fn octree_of_one_particle_and_of_none() {
    let min = common::scene(3, &[]).domain.min;
    let scene = scene_of(3, "y", &[min]);
    let one = Census::of(&scene, &[min]).octree();
    let levels = u64::from(one.levels);
    assert_eq!((one.leaves, one.inner), (1, levels));
    assert_eq!(
        (one.allocated_leaves, one.allocated_inner),
        (8, 1 + 8 * (levels - 1))
    );
    let none = Census::of(&scene, &[]).octree();
    assert_eq!((none.nodes(), none.allocated_nodes()), (0, 0));
}

#[test]
fn hash_tables_are_at_most_half_full() {
    assert_eq!([1, 2, 3, 65_536].map(hash_buckets), [2, 4, 8, 131_072]);
}

#[test]
fn every_search_has_what_the_host_counts() {
    for dimensions in [2, 3] {
        let points = points(dimensions, 3);
        for ((addressing, storage), axis) in common::grids_and_axes(dimensions) {
            let mut scene = scene_of(dimensions, axis, &points);
            scene.neighbors.addressing = addressing.kind;
            scene.neighbors.storage = storage.kind;
            let wanted = Wanted {
                statistics: true,
                ..Default::default()
            };
            let mut simulation = common::simulate(&scene, &wanted);
            simulation.next_frame().unwrap();
            let frame = simulation.finish_frame().unwrap().unwrap();
            let device = frame.statistics.unwrap();

            let census = Census::of(&scene, &points);
            let host = Allocation::of(&scene, &census);
            let figures = census.figures();
            let label = format!("{} × {}, {dimensions}D, {axis}", addressing.name, storage.name);
            assert_eq!(host.voxels, u64::from(device.voxels_allocated), "{label}");
            if let Some(slices) = &host.slices {
                assert_eq!(slices.len(), census.slices().len(), "{label}");
                // Slices beyond the domain hold nothing where those at its border take their particles.
                assert_eq!(slices.iter().sum::<u64>(), host.voxels, "{label}");
            }
            if addressing.name == "hash" {
                // Voxels share buckets.
                assert!(u64::from(device.voxels_occupied) <= figures.occupied, "{label}");
                assert!(device.voxels_occupied > 0 && host.overflow.is_none(), "{label}");
                continue;
            }
            assert_eq!(host.overflow, Some(device.overflow.into()), "{label}");
            assert_eq!(figures.occupied, u64::from(device.voxels_occupied), "{label}");
            assert_eq!(figures.with, device.voxels_with.map(u64::from), "{label}");
            assert_eq!(figures.with_more, u64::from(device.voxels_with_more), "{label}");
        }
    }
}

#[test]
fn slices_of_regions_add_up_to_what_the_device_has() {
    // Two clouds that a slice's box would span, and that no single slice shows to be parted.
    let min = common::scene(3, &[]).domain.min;
    let mut points = Vec::new();
    for i in 0..20 {
        let step = Vec3::new(0.02, 0.045, 0.02) * i as f32;
        points.extend([min + 0.1 * Vec3::ONE + step * Vec3::new(0.1, 1.0, 0.1)]);
        points.push(min + Vec3::new(0.85, 0.05, 0.65) + step * Vec3::new(0.1, 0.3, 0.1));
        points.push(min + Vec3::new(0.1 + 0.005 * i as f32, 0.4, 0.1));
    }
    let count = |regions: bool| {
        let mut scene = scene_of(3, "y", &points);
        scene.neighbors.regions = regions;
        let wanted = Wanted {
            statistics: true,
            ..Default::default()
        };
        let mut simulation = common::simulate(&scene, &wanted);
        simulation.next_frame().unwrap();
        let device = simulation.finish_frame().unwrap().unwrap().statistics.unwrap();
        let host = Allocation::of(&scene, &Census::of(&scene, &points));
        assert_eq!(host.voxels, u64::from(device.voxels_allocated));
        assert_eq!(host.slices.unwrap().iter().sum::<u64>(), host.voxels);
        host.voxels
    };
    assert!(count(true) < count(false));
}

#[test]
fn bytes_are_those_of_the_planned_buffers() {
    let points = points(3, 4);
    for addressing in ADDRESSINGS {
        for storage in STORAGES {
            let mut scene = scene_of(3, "y", &points);
            scene.neighbors.addressing = addressing.kind;
            scene.neighbors.storage = storage.kind;
            let census = Census::of(&scene, &points);
            let host = Allocation::of(&scene, &census);
            let limits = sliceflow::gpu::device::Limits::PROMISED;
            let plan = Plan::new(&scene, &limits, &Wanted::default()).unwrap();
            let find = |buffers: &[BufferPlan], name: &str| {
                let found = buffers.iter().find(|buffer| buffer.name == name);
                found.unwrap_or_else(|| panic!("no {name}")).bytes
            };
            let label = format!("{} × {}", addressing.name, storage.name);
            let mut smaller = false;
            for buffer in &host.buffers {
                let planned = find(&plan.buffers, &buffer.name);
                assert!(buffer.bytes <= planned, "{label}: {}", buffer.name);
                smaller |= buffer.bytes < planned;
            }
            // The plan's margin is in its grid's room.
            assert_eq!(smaller, census.grid.room() != plan.grid.room(), "{label}");
            let sum: u64 = host.buffers.iter().map(|buffer| buffer.bytes).sum();
            assert_eq!(host.bytes, sum, "{label}");
            assert!(
                host.bytes_per_voxel * host.voxels + host.particle_bytes <= host.bytes,
                "{label}"
            );
            assert!(host.bytes_per_voxel >= 4, "{label}");
        }
    }
}

#[test]
fn a_pool_of_four_slots_takes_twenty_bytes_a_voxel() {
    // Four indices and a counter; Harada 2007 packs the four indices into one texel of 16 bytes.
    let points = points(3, 5);
    let mut scene = scene_of(3, "y", &points);
    scene.neighbors.storage = sliceflow::scene::model::Storage::Pool;
    scene.neighbors.slots = 4;
    let neighbors = scene.neighbors;
    let census = Census::of(&scene, &points);
    assert_eq!(census.dimensions, Dimensions::Three);
    assert_eq!(Allocation::of(&scene, &census).bytes_per_voxel, 20);
    let octree = census.octree();
    let leaves = Allocation::storage_bytes(&neighbors, octree.leaves, census.particles);
    assert_eq!(octree.leaf_bytes(&neighbors, census.particles), leaves);
    assert_eq!(
        octree.bytes(&neighbors, census.particles),
        leaves + 32 * octree.inner
    );
    assert_eq!(leaves, 20 * octree.leaves + 8);
}
