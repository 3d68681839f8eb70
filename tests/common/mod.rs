//! What several test programs need.

use std::path::Path;
use std::sync::Mutex;

use glam::Vec3;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sliceflow::gpu::{AdapterChoice, Gpu};
use sliceflow::neighbors::addressing::AddressingRow;
use sliceflow::neighbors::storage::StorageRow;
use sliceflow::neighbors::{ADDRESSINGS, STORAGES};
use sliceflow::physics::layout::Convergence;
use sliceflow::plan::{Plan, Wanted};
use sliceflow::scene::{Particles, Scene, load};
use sliceflow::simulation::{Frame, Simulation};

/// A small scene that has a bit of everything, in two or three dimensions, with overrides.
#[allow(dead_code)]
pub fn scene(dimensions: usize, overrides: &[&str]) -> Scene {
    let text = match dimensions {
        2 => include_str!("scene_2d.json"),
        _ => include_str!("scene_3d.json"),
    };
    parsed(text, overrides)
}

/// A small tank of fluid with an obstacle that moves.
#[allow(dead_code)]
pub fn fluid(dimensions: usize, overrides: &[&str]) -> Scene {
    let text = match dimensions {
        2 => include_str!("fluid_2d.json"),
        _ => include_str!("fluid_3d.json"),
    };
    parsed(text, overrides)
}

#[allow(dead_code)]
fn parsed(text: &str, overrides: &[&str]) -> Scene {
    let overrides: Vec<String> = overrides.iter().map(|&o| o.to_owned()).collect();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/common");
    match load::parse(text, "test.json", &folder, &overrides) {
        Ok(scene) => scene,
        Err(error) => panic!("{error}"),
    }
}

/// The scene with particles at rest at these points in place of its own.
#[allow(dead_code)]
pub fn resting(mut scene: Scene, points: &[Vec3]) -> Scene {
    scene.particles = Particles {
        position: points.to_vec(),
        velocity: vec![Vec3::ZERO; points.len()],
        ..Particles::default()
    };
    scene.capacity = points.len() as u32;
    scene
}

/// A device with all checks in the shaders. Tests that run at the same time have one each; those that come later get a device
/// back with what it has compiled.
#[allow(dead_code)]
pub fn gpu() -> Gpu {
    static FREE: Mutex<Vec<Gpu>> = Mutex::new(Vec::new());
    /// Of one thread, which libtest makes for each test.
    struct Lent(Gpu);
    impl Drop for Lent {
        fn drop(&mut self) {
            FREE.lock().expect("devices").push(self.0.clone());
        }
    }
    thread_local! {
        static LENT: Lent = {
            let free = FREE.lock().expect("devices").pop();
            // One on which something went wrong fails no other test.
            let works = free.filter(|gpu| gpu.wait(None).is_ok());
            Lent(works.unwrap_or_else(|| {
                Gpu::open(&AdapterChoice::Best, true).expect("tests need an adapter; software Vulkan will do")
            }))
        };
    }
    LENT.with(|lent| lent.0.clone())
}

/// A simulation of a scene on the test adapter, with all checks in the shaders.
#[allow(dead_code)]
pub fn simulate(scene: &Scene, wanted: &Wanted) -> Simulation {
    let gpu = gpu();
    let plan = Plan::new(scene, &gpu.limits, wanted).expect("a plan");
    Simulation::new(gpu, scene, &plan).expect("a simulation")
}

/// A way to address voxels and a way to keep particles in them.
#[allow(dead_code)]
pub type GridRows = (&'static AddressingRow, &'static StorageRow);

/// Each way to address voxels with one way to keep particles; every way to keep them occurs. Each `shift` gives other pairs.
///
/// Compiling shaders is what tests spend their time on, and every pair has some of its own. `random_points` of
/// `tests/library/neighbors.rs` has all pairs.
#[allow(dead_code)]
pub fn grids_in_turn(shift: usize) -> Vec<GridRows> {
    let storages = STORAGES.iter().cycle().skip(shift);
    ADDRESSINGS.iter().zip(storages).collect()
}

/// Each way to address voxels with each storage that is queried in its own way: those that sort particles answer alike, and
/// take turns.
#[allow(dead_code)]
pub fn grids_by_query() -> Vec<GridRows> {
    let (sorting, others): (Vec<_>, Vec<_>) = STORAGES.iter().partition(|row| row.sorts);
    let in_turn = ADDRESSINGS.iter().zip(sorting.into_iter().cycle());
    in_turn
        .flat_map(|(addressing, sorting)| {
            let storages = [sorting].into_iter().chain(others.clone());
            storages.map(move |storage| (addressing, storage))
        })
        .collect()
}

/// Grids with the axes across which they are sliced: in 3D every grid that is queried in its own way, in 2D every way to
/// address voxels. Which way slices lie makes no difference to how voxels keep particles.
#[allow(dead_code)]
pub fn grids_and_axes(dimensions: usize) -> Vec<(GridRows, &'static str)> {
    let (grids, others): (_, &[&str]) = match dimensions {
        2 => (grids_in_turn(0), &["x"]),
        _ => (grids_by_query(), &["x", "z"]),
    };
    let sliced = grids_in_turn(1).into_iter().filter(|grid| has_slices(grid.0));
    let turned = sliced.flat_map(|grid| others.iter().map(move |&axis| (grid, axis)));
    grids.into_iter().map(|grid| (grid, "y")).chain(turned).collect()
}

/// Whether it matters across which axis slices lie.
#[allow(dead_code)]
pub fn has_slices(addressing: &AddressingRow) -> bool {
    !["uniform", "hash", "morton"].contains(&addressing.name)
}

/// Frames up to `last`, and those under way.
#[allow(dead_code)]
pub fn frames(simulation: &mut Simulation, last: u32) -> Vec<Frame> {
    let mut frames = Vec::new();
    while simulation.next_index() <= last {
        frames.extend(simulation.next_frame().expect("a frame"));
    }
    while let Some(frame) = simulation.finish_frame().expect("a frame") {
        frames.push(frame);
    }
    frames
}

/// Frames 0 to `last` with figures over all particles.
#[allow(dead_code)]
pub fn measured_frames(scene: &Scene, last: u32) -> (Simulation, Vec<Frame>) {
    let wanted = Wanted {
        statistics: true,
        ..Default::default()
    };
    let mut simulation = simulate(scene, &wanted);
    let frames = frames(&mut simulation, last);
    (simulation, frames)
}

/// Of a fluid of `dfsph`.
#[allow(dead_code)]
pub fn convergence(frame: &Frame) -> Convergence {
    frame.convergence.expect("figures of the loops")
}

/// Particles in a scene with open sides and nothing else in it.
#[allow(dead_code)]
pub fn open_scene(dimensions: usize, choices: &[&str], position: Vec<Vec3>, velocity: Vec<Vec3>) -> Scene {
    let open = [
        "domain.walls=open",
        "domain.sides={}",
        "colliders=[]",
        "gravity=[0,0,0]",
    ];
    let two = [
        "domain.walls=open",
        "domain.sides={}",
        "colliders=[]",
        "gravity=[0,0]",
    ];
    let open = if dimensions == 2 { two } else { open };
    let all: Vec<&str> = open.iter().chain(choices).copied().collect();
    let mut scene = scene(dimensions, &all);
    scene.capacity = position.len() as u32;
    scene.particles = Particles {
        position,
        velocity,
        ..Particles::default()
    };
    scene
}

/// A ball of grains that flies apart: positions and velocities.
#[allow(dead_code)]
pub fn burst(dimensions: usize, count: usize) -> (Vec<Vec3>, Vec<Vec3>) {
    let base = scene(dimensions, &[]);
    let reach = 2.0 * base.radius() as f32;
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut unit = || {
        let z = if dimensions == 2 { 0.5 } else { rng.random() };
        Vec3::new(rng.random(), rng.random(), z) - 0.5
    };
    let position: Vec<Vec3> = (0..count).map(|_| unit() * 8.0 * reach).collect();
    let velocity = (0..count).map(|_| unit() * 60.0).collect();
    (position, velocity)
}
