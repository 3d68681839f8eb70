//! Prefix sums and sorts of the storages against the CPU: the planned passes themselves, on given particles.

mod common;

use glam::Vec3;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sliceflow::gpu::{AdapterChoice, Buffers, Gpu, Kernels, PassPlan, readback};
use sliceflow::neighbors::{Grid, STORAGES, first_grid};
use sliceflow::physics::layout::Parameters;
use sliceflow::plan::{Phase, Plan, Wanted};
use sliceflow::scene::Scene;
use sliceflow::simulation::passes::Passes;

/// Around the sizes of workgroups (64), of scanning workgroups (256), of blocks, and of 2^16.
const SIZES: &[usize] = &[0, 1, 2, 31, 255, 256, 257, 65_537, 400_000];

/// A plan's buffers and passes without a simulation around them.
struct Bench {
    gpu: Gpu,
    plan: Plan,
    buffers: Buffers,
}

impl Bench {
    /// `groups`: workgroups in one dimension of a dispatch.
    fn new(scene: &Scene, groups: Option<u32>) -> Self {
        let mut gpu = Gpu::open(&AdapterChoice::Best, true).expect("an adapter; software Vulkan will do");
        gpu.limits.groups = groups.unwrap_or(gpu.limits.groups);
        let plan = Plan::new(scene, &gpu.limits, &Wanted::default()).expect("a plan");
        let mut buffers = Buffers::default();
        for buffer in &plan.buffers {
            buffers.make(&gpu, buffer).expect("a buffer");
        }
        let bench = Self { gpu, plan, buffers };
        bench.write("grid", &[bench.plan.grid]);
        bench
    }

    fn write<T: bytemuck::NoUninit>(&self, name: &str, values: &[T]) {
        self.buffers
            .write(&self.gpu, name, 0, values)
            .expect("the buffer");
    }

    fn read<T: bytemuck::Pod>(&self, name: &str, count: usize) -> Vec<T> {
        let buffer = self.buffers.get(name, "(test)").expect("the buffer");
        readback::read(&self.gpu, buffer, count).expect("its values")
    }

    /// Runs the search's passes that are wanted, in their order, for so many particles.
    fn run(&self, particles: usize, wanted: impl Fn(&PassPlan) -> bool) {
        let Self { gpu, plan, buffers } = self;
        let particle_count = particles as u32;
        self.write(
            "parameters",
            &[Parameters {
                particle_count,
                ..Default::default()
            }],
        );
        self.write(
            "dispatch",
            &plan.dispatch(particle_count, particle_count, &gpu.limits),
        );
        let mut passes = Passes::new(gpu, plan, buffers, &mut Kernels::default()).expect("passes");
        let planned = plan.in_phase(Phase::Start);
        let steps = planned.zip(passes.start.drain(..));
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut compute = encoder.begin_compute_pass(&Default::default());
        for (_, step) in steps.filter(|(planned, _)| wanted(planned)) {
            step.pass
                .dispatch(&mut compute, step.groups(buffers).expect("workgroups"));
        }
        drop(compute);
        gpu.queue.submit([encoder.finish()]);
    }
}

/// The scene of the tests, with a uniform grid and room for so many particles.
fn scene(storage: &str, capacity: usize, overrides: &[&str]) -> Scene {
    let storage = format!("neighbors.storage={storage}");
    let mut all = vec![
        "neighbors.addressing=uniform",
        &storage,
        "neighbors.skin=0",
        "colliders=[]",
    ];
    all.extend(overrides);
    let mut scene = common::scene(3, &all);
    scene.capacity = capacity.max(1) as u32;
    scene
}

/// Names of the storages that put particles in voxel order.
fn sorted_storages() -> impl Iterator<Item = &'static str> {
    let sorted = STORAGES.iter().filter(|row| row.query == "storage/sorted/query");
    sorted.map(|row| row.name)
}

/// Address in a uniform grid.
fn voxel(grid: &Grid, p: Vec3) -> u32 {
    let [u, s, w] = grid.voxel_in_domain(p);
    (u + grid.size[0] * (w + grid.size[2] * s)) as u32
}

/// Random points: everywhere, or in a few voxels of one corner.
fn points(scene: &Scene, count: usize, clustered: bool) -> Vec<Vec3> {
    let mut rng = ChaCha8Rng::seed_from_u64(count as u64);
    let min = scene.domain.min;
    let extent = if clustered {
        Vec3::splat(5.0 * scene.radius() as f32)
    } else {
        scene.domain.max - min
    };
    let mut unit = || Vec3::new(rng.random(), rng.random(), rng.random());
    (0..count).map(|_| min + extent * unit()).collect()
}

/// Sorts points on the device and holds the result against a stable sort on the CPU.
fn check_sort(scene: &Scene, points: &[Vec3], groups: Option<u32>, what: &str) {
    let bench = Bench::new(scene, groups);
    let grid = bench.plan.grid;
    let packed: Vec<[f32; 4]> = points.iter().map(|p| [p.x, p.y, p.z, 0.0]).collect();
    let ids: Vec<u32> = (0..points.len() as u32).collect();
    let voxels: Vec<u32> = points.iter().map(|&p| voxel(&grid, p)).collect();
    let mut expected = ids.clone();
    expected.sort_by_key(|&id| voxels[id as usize]);
    let mut start = vec![0u32; grid.capacity as usize + 1];
    for &voxel in &voxels {
        start[voxel as usize + 1] += 1;
    }
    for voxel in 0..grid.capacity as usize {
        start[voxel + 1] += start[voxel];
    }
    // Twice: the second search must find all counters as the first one did.
    for turn in ["first", "second"] {
        bench.write("next_position", &packed);
        bench.write("next_id", &ids);
        bench.run(points.len(), |_| true);
        let found: Vec<u32> = bench.read("id", points.len());
        assert!(found == expected, "{what}, {turn} time: order");
        let found: Vec<u32> = bench.read("voxel_start", start.len());
        assert!(found == start, "{what}, {turn} time: first particles of voxels");
        let found: Vec<[f32; 4]> = bench.read("position", points.len());
        let moved = found
            .iter()
            .zip(&expected)
            .all(|(p, &id)| *p == packed[id as usize]);
        assert!(moved, "{what}, {turn} time: state");
        bench.write("id", &vec![u32::MAX; points.len()]);
        bench.write("voxel_start", &vec![u32::MAX; start.len()]);
    }
}

#[test]
fn every_sort_is_the_cpus_stable_sort() {
    for storage in sorted_storages() {
        for &size in SIZES {
            // Counting's canonical order costs the square of a voxel's particles.
            let radius = if size > 257 {
                "grains.radius=0.005"
            } else {
                "grains.radius=0.03"
            };
            let scene = scene(storage, size, &[radius]);
            let spread = points(&scene, size, false);
            check_sort(&scene, &spread, None, &format!("{storage}, {size} points"));
            if size <= 257 {
                let clustered = points(&scene, size, true);
                check_sort(
                    &scene,
                    &clustered,
                    None,
                    &format!("{storage}, {size} in few voxels"),
                );
            }
        }
    }
}

#[test]
fn sorts_leave_room_for_particles_to_come() {
    for storage in sorted_storages() {
        let scene = scene(storage, 5000, &[]);
        for size in [0, 1, 1023, 1025, 4097] {
            let some = points(&scene, size, false);
            check_sort(&scene, &some, None, &format!("{storage}, {size} of 5000"));
        }
    }
}

#[test]
fn folded_dispatches_sort_too() {
    // At most four workgroups a dimension, so 16 groups of at least 64 threads in all.
    for storage in sorted_storages() {
        for size in [0, 1, 2, 31, 255, 256, 257, 900] {
            let scene = scene(storage, size, &[]);
            let some = points(&scene, size, false);
            check_sort(
                &scene,
                &some,
                Some(4),
                &format!("{storage}, {size} points, folded"),
            );
        }
    }
}

#[test]
fn a_full_packed_pair_is_not_taken_for_the_end() {
    // 2^16 particles, all in the last of 2^16 voxels: the last pair has all bits set. With fewer, others come last.
    let mut scene = flat(256);
    let far = scene.domain.max;
    scene.capacity = 1 << 16;
    let plan = Plan::new(
        &scene,
        &sliceflow::gpu::device::Limits::PROMISED,
        &Wanted::default(),
    )
    .unwrap();
    assert!(plan.variant.flags.contains("packed_pairs"));
    let bench = Bench::new(&scene, None);
    let points = vec![[far.x, far.y, 0.0, 0.0]; 1 << 16];
    let ids: Vec<u32> = (0..1 << 16).rev().collect();
    bench.write("next_position", &points);
    bench.write("next_id", &ids);
    for count in [1 << 16, 1000] {
        bench.run(count, |_| true);
        assert!(
            bench.read::<u32>("id", count) == ids[..count],
            "{count} particles"
        );
        let start: Vec<u32> = bench.read("voxel_start", (1 << 16) + 1);
        assert_eq!(start[(1 << 16) - 1..], [0, count as u32]);
    }
}

/// A 2D scene of n × n voxels with a bitonic sort.
fn flat(n: u32) -> Scene {
    let mut scene = common::scene(
        2,
        &[
            "neighbors.addressing=uniform",
            "neighbors.storage=bitonic",
            "neighbors.skin=0",
            "colliders=[]",
        ],
    );
    let reach = 2.0 * scene.radius() as f32;
    scene.domain.max = scene.domain.min + Vec3::new(1.0, 1.0, 0.0) * reach * (n as f32 - 0.5);
    assert_eq!(first_grid(&scene).size[..2], [n as i32; 2]);
    scene
}

#[test]
fn pairs_are_packed_up_to_the_limits_of_rojas() {
    let why = |scene: &Scene| {
        let plan = Plan::new(
            scene,
            &sliceflow::gpu::device::Limits::PROMISED,
            &Wanted::default(),
        )
        .unwrap();
        let pairs = plan.buffers.iter().find(|b| b.name == "sort_pairs").unwrap();
        (
            pairs.bytes / u64::from(scene.capacity),
            plan.variant.flags.contains("packed_pairs"),
            pairs.why.clone(),
        )
    };
    let mut scene = flat(256);
    scene.capacity = 1 << 16;
    let (bytes, packed, reason) = why(&scene);
    assert_eq!((bytes, packed), (4, true), "{reason}");
    scene.capacity += 1;
    let (bytes, packed, reason) = why(&scene);
    assert_eq!((bytes, packed), (8, false));
    assert!(reason.contains("65536 particles, not 65537"), "{reason}");
    let (bytes, packed, reason) = why(&flat(257));
    assert_eq!((bytes, packed), (8, false));
    assert!(reason.contains("65536 voxels, not 66049"), "{reason}");
}

/// Runs the voxels' prefix sum over random counts.
fn check_scan(voxels: usize, groups: Option<u32>) {
    let scene = scene("counting", 1, &["grains.radius=0.0045"]);
    let mut bench = Bench::new(&scene, groups);
    // The capacity of a uniform grid is its number of voxels; there are two items more.
    assert!(bench.plan.grid.capacity as usize >= voxels);
    bench.plan.grid.capacity = voxels as u32;
    bench.write("grid", &[bench.plan.grid]);
    let mut rng = ChaCha8Rng::seed_from_u64(voxels as u64);
    let counts: Vec<u32> = (0..voxels + 2).map(|_| rng.random_range(0..5)).collect();
    bench.write("voxel_start", &counts);
    bench.run(1, |pass| pass.shader == "storage/sorted/scan_voxels");
    let before = |sum: &mut u32, count: &u32| {
        *sum += count;
        Some(*sum - count)
    };
    let expected: Vec<u32> = counts.iter().scan(0, before).collect();
    let found: Vec<u32> = bench.read("voxel_start", voxels + 2);
    assert!(found == expected, "{voxels} voxels: sums");
}

#[test]
fn prefix_sums_are_the_cpus() {
    for &voxels in SIZES {
        check_scan(voxels, None);
    }
}

#[test]
fn folded_prefix_sums_are_too() {
    // A block is 2048 items: 40 workgroups per dimension are folded beyond 81,920.
    for voxels in [
        0, 1, 2, 31, 255, 256, 257, 2046, 2047, 81_917, 81_918, 81_919, 100_000,
    ] {
        check_scan(voxels, Some(40));
    }
}
