//! Boundary particles that no fluid can reach before the next search: which they are, and that they cost neither list nor pass.

use std::path::Path;

use glam::Vec3;
use sliceflow::gpu::{Limits, readback};
use sliceflow::neighbors::{Room, lists};
use sliceflow::plan::{Plan, Wanted};
use sliceflow::scene::{Scene, load};
use sliceflow::simulation::{Frame, Simulation};

use crate::common;

fn parsed(text: &str) -> Scene {
    load::parse(text, "test.json", Path::new("."), &[]).unwrap_or_else(|error| panic!("{error}"))
}

fn numbers<T: bytemuck::Pod>(simulation: &Simulation, name: &str, count: usize) -> Vec<T> {
    let buffer = simulation.buffers().get(name, "(test)").expect("it is there");
    readback::read(simulation.gpu(), buffer, count).expect("its numbers")
}

/// Slots of the boundary particles that the last search found in reach.
fn reached(simulation: &Simulation) -> Vec<u32> {
    let count = numbers::<u32>(simulation, "reached", 1)[0] as usize;
    numbers(simulation, "reached", 1 + count)[1..].to_vec()
}

/// The same on the host: those that fluid comes nearer than the radius and the skin if it goes straight on.
fn reached_on_host(simulation: &Simulation, scene: &Scene) -> Vec<u32> {
    let count = scene.capacity as usize;
    let [position, velocity] = ["position", "velocity"].map(|name| -> Vec<Vec3> {
        let of_particles = numbers::<[f32; 4]>(simulation, name, count).into_iter();
        of_particles.map(|[x, y, z, _]| Vec3::new(x, y, z)).collect()
    });
    let grid = sliceflow::neighbors::first_grid(scene);
    let ids: Vec<u32> = numbers(simulation, "id", count);
    let (fluid, boundary): (Vec<u32>, Vec<u32>) =
        (0..count as u32).partition(|&slot| ids[slot as usize] < scene.first_boundary());
    let near = |wall: u32, drop: u32| {
        let (apart, v) = (
            position[drop as usize] - position[wall as usize],
            velocity[drop as usize],
        );
        let nearest = (-apart.dot(v) / v.length_squared().max(1e-30)).clamp(0.0, grid.list_horizon);
        (apart + nearest * v).length() < grid.list_reach
    };
    boundary
        .into_iter()
        .filter(|&wall| fluid.iter().any(|&drop| near(wall, drop)))
        .collect()
}

#[test]
fn boundary_particles_in_reach_are_those_with_fluid_within_reach() {
    let all: [&[&str]; 3] = [
        // The obstacle moves.
        &["neighbors.addressing=sliced"],
        &[
            "neighbors.addressing=bitmap",
            "neighbors.storage=radix",
            "colliders=[]",
        ],
        &["neighbors.storage=bitonic", "neighbors.skin=0.3"],
    ];
    for dimensions in [2, 3] {
        // How particles are sorted is told apart in 2D.
        for &choices in &all[..if dimensions == 2 { 3 } else { 1 }] {
            let scene = common::fluid(dimensions, choices).with_steps_per_frame(20);
            let mut simulation = common::simulate(&scene, &Wanted::default());
            let mut counts = Vec::new();
            for frame in 0..3 {
                common::frames(&mut simulation, frame);
                let found = reached(&simulation);
                let label = format!("{dimensions}D, {choices:?}, frame {frame}");
                assert_eq!(found, reached_on_host(&simulation, &scene), "{label}");
                counts.push(found.len());
            }
            let all = scene.boundary.len();
            assert!(
                counts.iter().all(|&count| count > 0 && count < all),
                "{counts:?} of {all}"
            );
        }
    }
}

/// A drop that falls into a wide tank and spreads.
fn drop_in_a_tank() -> Scene {
    parsed(
        r#"{
            "dimensions": 2,
            "domain": { "min": [0, 0], "max": [4, 1] },
            "gravity": [0, -10],
            "fluid": { "solver": "wcsph", "spacing": 0.05, "max_speed": 5, "viscosity": 5, "background_pressure": 100 },
            "bodies": [
                { "shape": { "kind": "box", "min": [1.5, 0.05], "max": [2.5, 0.5] }, "velocity": [0, -1] }
            ],
            "time": { "duration": 0.4, "fps": 10 }
        }"#,
    )
}

/// A run with room for so many boundary particles in reach, up to a frame.
fn run(scene: &Scene, room: Option<u32>, last: u32) -> (Simulation, Vec<Frame>) {
    let gpu = common::gpu();
    let wanted = Wanted {
        statistics: true,
        ..Default::default()
    };
    let mut plan = Plan::new(scene, &gpu.limits, &wanted).expect("a plan");
    if let Some(reached) = room {
        let grid = plan.grid.with_room(Room {
            reached,
            ..plan.grid.room()
        });
        plan = plan.with_grid(scene, &gpu.limits, grid).expect("a plan");
    }
    let mut simulation = Simulation::new(gpu, scene, &plan).expect("a simulation");
    let frames = common::frames(&mut simulation, last);
    (simulation, frames)
}

#[test]
fn lists_grow_when_water_spreads_and_no_bit_differs() {
    let scene = drop_in_a_tank();
    let (roomy, usual) = run(&scene, Some(scene.boundary.len() as u32), 0);
    let at_start = reached(&roomy).len() as u32;
    assert!(usual[0].reallocations == 0 && at_start > 0);
    let (roomy, usual) = run(&scene, Some(scene.boundary.len() as u32), 4);
    let (tight, grown) = run(&scene, Some(at_start), 4);
    assert!(reached(&roomy).len() as u32 > at_start, "water spreads");
    assert_eq!(reached(&tight), reached(&roomy));
    assert_eq!(grown[0].reallocations, 0);
    assert!(
        grown.iter().any(|frame| frame.reallocations > 0),
        "nothing had to grow"
    );
    for (a, b) in grown.iter().zip(&usual) {
        assert_eq!((a.steps, a.searches), (b.steps, b.searches));
        assert_eq!(a.statistics, b.statistics, "frame {}", a.index);
        assert_eq!(b.reallocations, 0);
    }
    let columns = [
        "position",
        "velocity",
        "fluid_state",
        "next_position",
        "viscous_velocity",
    ];
    for name in columns {
        let each = if name == "fluid_state" { 2 } else { 4 };
        let count = each * scene.capacity as usize;
        let of = |simulation: &Simulation| numbers::<u32>(simulation, name, count);
        assert_eq!(of(&tight), of(&roomy), "{name}");
    }
    // Nothing at all has room before the first search.
    let (_, grown) = run(&scene, Some(0), 1);
    assert!(grown[0].reallocations > 0);
    assert_eq!(grown[1].statistics, usual[1].statistics);
}

/// Boundary particles out of reach have the state of one without fluid beside it, in both of their buffers.
#[test]
fn out_of_reach_nothing_presses() {
    let mut scene = drop_in_a_tank();
    scene.time.steps_per_frame = 30;
    let (simulation, _) = run(&scene, None, 1);
    let count = scene.capacity as usize;
    let reached = reached(&simulation);
    let state: Vec<[f32; 2]> = numbers(&simulation, "fluid_state", count);
    // The density deviation that the flow carries along stands beside velocity.
    let [position, next_position, velocity] =
        ["position", "next_position", "velocity"].map(|name| numbers::<[f32; 4]>(&simulation, name, count));
    let unreached = (scene.first_boundary()..scene.capacity).filter(|slot| !reached.contains(slot));
    let mut found = 0;
    for slot in unreached.map(|slot| slot as usize) {
        assert_eq!((state[slot], velocity[slot][3]), ([0.0, 100.0], 0.0));
        assert_eq!(position[slot], next_position[slot]);
        found += 1;
    }
    assert!(
        found > scene.boundary.len() / 3,
        "{found} of {}",
        scene.boundary.len()
    );
    assert!(reached.iter().any(|&slot| state[slot as usize][1] > 100.0));
}

/// A dam of 59,319 particles in a tank of 4 × 3 × 1.5 m, whose walls have four times as many.
#[test]
fn a_dam_in_a_large_tank_has_lists_within_the_limits_of_software() {
    let scene = parsed(
        r#"{
            "domain": { "min": [-2, 0, -0.75], "max": [2, 3, 0.75] },
            "fluid": { "solver": "wcsph", "spacing": 0.025, "density": 1000, "viscosity": 10 },
            "bodies": [
                { "shape": { "kind": "box", "min": [-1.9375, 0.0625, -0.4875], "max": [-0.9625, 1.0375, 0.4875] } }
            ],
            "time": { "duration": 1, "fps": 25 }
        }"#,
    );
    assert_eq!((scene.particles.len(), scene.boundary.len()), (59_319, 228_456));
    let limits = Limits {
        binding: 128 << 20,
        ..Limits::PROMISED
    };
    let plan = Plan::new(&scene, &limits, &Wanted::default()).expect("a plan");
    assert_eq!(plan.lists_left_out, None);
    // As long as the scene's margin wants them.
    let usual = f64::from(lists::usual_length(&scene));
    assert_eq!(
        plan.grid.list_capacity,
        (usual * scene.neighbors.margin).ceil() as u32
    );
    let bytes = |name: &str| {
        plan.buffers
            .iter()
            .find(|buffer| buffer.name == name)
            .map(|buffer| buffer.bytes)
    };
    assert!(
        bytes("neighbor_list") < Some(40 << 20),
        "{:?}",
        bytes("neighbor_list")
    );
    for entry in ["extend_to_boundary", "move_boundary"] {
        let row = plan
            .passes
            .iter()
            .find(|row| row.pass.entry == entry)
            .expect("it runs");
        let threads = plan.most_items(row.pass.items, plan.capacity);
        assert!(threads < 59_319 + 228_456 / 20, "{entry}: {threads}");
    }
    let moved = plan
        .passes
        .iter()
        .find(|row| row.pass.entry == "move_fluid")
        .expect("it runs");
    assert_eq!(plan.most_items(moved.pass.items, plan.capacity), 59_319);
}
