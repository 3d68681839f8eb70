//! The incompressible solver `dfsph`: its loops converge on the device, water comes to rest, and nothing depends on the grid.

use std::path::Path;

use glam::{DVec3, Vec3};
use sliceflow::gpu::readback;
use sliceflow::neighbors::{ADDRESSINGS, STORAGES};
use sliceflow::physics::kernels;
use sliceflow::scene::{Scene, load};
use sliceflow::simulation::Frame;

use crate::common::{self, convergence, measured_frames as frames};

fn dfsph(dimensions: usize, overrides: &[&str]) -> Scene {
    common::fluid(dimensions, &[&["fluid.solver=dfsph"], overrides].concat())
}

#[test]
fn water_that_fills_a_tank_comes_to_rest_at_its_level() {
    let scene = dfsph(
        2,
        &[
            "colliders=[]",
            "bodies[0].shape.max=[1,0.4]",
            "time={\"duration\":6,\"fps\":2}",
            "fluid.viscosity=1",
        ],
    );
    let (simulation, frames) = frames(&scene, 12);
    let last = frames.last().expect("frames");
    let statistics = last.statistics.expect("statistics");
    // √(gH) is 0.63 m/s.
    assert!(statistics.max_speed < 0.05, "{}", statistics.max_speed);
    let [_, most] = statistics.density_error.expect("a fluid's");
    assert!(
        most < 0.5,
        "surface particles lack neighbors, none is pressed together: {most}"
    );
    let position = simulation.particles().expect("particles").position;
    let place = |p: &Vec3| p.as_dvec3() + scene.origin;
    let height = position.iter().map(|p| place(p).y).sum::<f64>() / position.len() as f64;
    assert!((height - 0.2).abs() < 0.02 * 0.4, "mean height {height} m");
    assert!(
        position
            .iter()
            .map(place)
            .all(|p| p.y > 0.0 && p.x > 0.0 && p.x < 1.0)
    );
    let loops = convergence(last);
    assert_eq!((loops.density_unconverged, loops.divergence_unconverged), (0, 0));
}

#[test]
fn loops_end_on_the_device_when_they_have_converged() {
    let scene = dfsph(3, &[]);
    let (_, frames) = frames(&scene, 2);
    let loops = convergence(&frames[2]);
    let most = scene.fluid().expect("a fluid").max_iterations;
    assert!(loops.steps > 0);
    for (iterations, longest, error, allowed) in [
        (
            loops.density_iterations,
            loops.most_density_iterations,
            loops.density_error,
            1e-4,
        ),
        (
            loops.divergence_iterations,
            loops.most_divergence_iterations,
            loops.divergence_error,
            1e-4,
        ),
    ] {
        assert!(iterations >= loops.steps, "at least one iteration per step");
        assert!(longest < most, "{longest} of {most}");
        assert!(error <= allowed, "{error}");
    }

    // A loop that may not go on as long as it needs says so.
    let short = dfsph(3, &["fluid.max_iterations=3", "fluid.max_divergence_error=1e-6"]);
    let (_, frames) = self::frames(&short, 2);
    let loops = convergence(&frames[2]);
    assert!(loops.divergence_unconverged > 0 && loops.most_divergence_iterations == 3);
}

#[test]
fn a_block_in_free_flight_keeps_its_momentum() {
    for dimensions in [2, 3] {
        let mut scene = dfsph(
            dimensions,
            &["colliders=[]", "domain.walls=open", "fluid.viscosity=0.1"],
        );
        let velocity = Vec3::new(0.5, 0.3, 0.0);
        for (k, v) in scene.particles.velocity.iter_mut().enumerate() {
            // Thrown about, so that particles meet.
            *v = velocity + 0.2 * Vec3::new((1.7 * k as f32).sin(), (2.3 * k as f32).cos(), 0.0);
        }
        let mean = |v: &[Vec3]| v.iter().map(|v| v.as_dvec3()).sum::<DVec3>() / v.len() as f64;
        let gravity = scene.gravity.as_dvec3();
        let before = mean(&scene.particles.velocity);
        let (simulation, frames) = frames(&scene, 2);
        let time = frames[2].time;
        let after = mean(&simulation.particles().expect("particles").velocity);
        let off = (after - before - gravity * time).length();
        assert!(
            off < 1e-5,
            "{dimensions}D: momentum is off by {off} m/s per particle"
        );
    }
}

/// The change of a velocity in a step is what the particle's pressure and its remainder, as they stand afterwards, and those
/// of its neighbors do: (I_i + I_j) ∇W / ρ, with I = (p + r) Δt. What is found of the remainder in a step acts in it.
#[test]
fn pressures_and_remainders_are_what_acts() {
    for dimensions in [2, 3] {
        let given = [
            "colliders=[]",
            "domain.walls=open",
            "fluid.viscosity=0",
            "fluid.artificial_viscosity=0",
        ];
        let mut scene = dfsph(dimensions, &given);
        let fluid = scene.fluid().expect("a fluid").clone();
        // Without order, and pressed together.
        let count = scene.particles.len();
        let middle = scene.particles.position.iter().sum::<Vec3>() / count as f32;
        for k in 0..count {
            let wave = Vec3::new(
                (1.7 * k as f32).sin(),
                (2.3 * k as f32).cos(),
                (3.1 * k as f32).sin(),
            );
            let wave = if dimensions == 2 { wave.with_z(0.0) } else { wave };
            let x = &mut scene.particles.position[k];
            *x += 0.1 * fluid.spacing as f32 * wave;
            scene.particles.velocity[k] = middle - *x;
        }
        scene.time.adaptive = None;
        scene.time.steps_per_frame = 1;
        scene.time.fps = 1.0 / scene.time.step;
        let (simulation, frames) = frames(&scene, 1);
        assert_eq!(frames[1].steps, 1);
        let dt = frames[1].time;

        let buffer = |name| simulation.buffers().get(name, "(test)").expect("the buffer");
        let stored = |name| -> Vec<[f32; 4]> {
            readback::read(simulation.gpu(), buffer(name), count).expect("its numbers")
        };
        let ids: Vec<u32> = readback::read(simulation.gpu(), buffer("id"), count).expect("ids");
        // By id: velocity, then impulses of pressure and remainder.
        let mut after = vec![(DVec3::ZERO, [0.0; 2]); count];
        for ((id, x), v) in ids.iter().zip(stored("position")).zip(stored("velocity")) {
            let velocity = DVec3::new(v[0].into(), v[1].into(), v[2].into());
            after[*id as usize] = (velocity, [v[3], x[3]].map(|p| dt * f64::from(p)));
        }
        let h = fluid.smoothing();
        let lattice = kernels::lattice(fluid.kernel, dimensions, h, fluid.spacing);
        // A lattice has rest density, and the right gradients.
        let density = kernels::lattice_density(fluid.kernel, dimensions, h, fluid.spacing);
        let volume = fluid.volume(scene.dimensions) / density / lattice.gradient;
        let (mut error, mut by_remainder) = (0.0, 0.0);
        for (i, (velocity, own)) in after.iter().enumerate() {
            let mut by = [DVec3::ZERO; 2];
            for (j, (_, other)) in after.iter().enumerate().filter(|(j, _)| *j != i) {
                let away = (scene.particles.position[j] - scene.particles.position[i]).as_dvec3();
                let r = away.length();
                let gradient = away * (volume * kernels::slope(fluid.kernel, dimensions, h, r) / r);
                for k in 0..2 {
                    by[k] += (own[k] + other[k]) * gradient / fluid.materials[0].density;
                }
            }
            let before = scene.particles.velocity[i].as_dvec3() + dt * scene.gravity.as_dvec3();
            error += (*velocity - before - by[0] - by[1]).length();
            by_remainder += by[1].length();
        }
        let [error, by_remainder] = [error, by_remainder].map(|sum| sum / count as f64);
        println!("{dimensions}D: off by {error:.2e} m/s, remainders do {by_remainder:.2e} m/s");
        assert!(by_remainder > 1e-3, "{dimensions}D: {by_remainder} m/s");
        assert!(
            error < 0.02 * by_remainder,
            "{dimensions}D: {error} of {by_remainder} m/s"
        );
    }
}

/// Each kind of viscosity by itself damps what a fluid without any keeps.
#[test]
fn viscosities_damp() {
    let energy = |viscosity: &str, artificial: &str| {
        let mut scene = dfsph(
            2,
            &[
                "colliders=[]",
                "domain.walls=open",
                "gravity=[0,0]",
                viscosity,
                artificial,
            ],
        );
        for (k, v) in scene.particles.velocity.iter_mut().enumerate() {
            *v = 0.2 * Vec3::new((1.7 * k as f32).sin(), (2.3 * k as f32).cos(), 0.0);
        }
        let last = frames(&scene, 1).1.pop().expect("frames");
        last.statistics.expect("statistics").kinetic_energy
    };
    let free = energy("fluid.viscosity=0", "fluid.artificial_viscosity=0");
    let viscous = energy("fluid.viscosity=5", "fluid.artificial_viscosity=0");
    let artificial = energy("fluid.viscosity=0", "fluid.artificial_viscosity=0.5");
    assert!(viscous < 0.9 * free, "{viscous} J, {free} J without");
    assert!(artificial < 0.9 * free, "{artificial} J, {free} J without");
}

#[test]
fn every_grid_gives_the_same_flow() {
    let place = |grid: &[&str]| {
        let scene = dfsph(2, grid);
        frames(&scene, 1).0.particles().expect("particles").position
    };
    let expected = place(&[]);
    let addressings = ADDRESSINGS.iter().map(|row| (row.name, "counting"));
    let storages = STORAGES.iter().map(|row| ("sliced", row.name));
    for (addressing, storage) in addressings.chain(storages) {
        let choice = [
            format!("neighbors.addressing={addressing}"),
            format!("neighbors.storage={storage}"),
            "neighbors.slots=64".to_owned(),
        ];
        let found = place(&choice.each_ref().map(String::as_str));
        let apart = |(a, b): (&Vec3, &Vec3)| a.distance(*b);
        let farthest = found.iter().zip(&expected).map(apart).fold(0.0, f32::max);
        // Sums in another order, over some steps.
        assert!(farthest < 2e-4, "{addressing}-{storage}: {farthest} m");
    }
}

fn energy(frame: &Frame) -> f64 {
    let statistics = frame.statistics.expect("statistics");
    statistics.kinetic_energy + statistics.potential_energy
}

/// A block of water, 32 particles high, hits the floor with all of itself at once.
#[test]
fn an_impact_gives_no_energy() {
    let scene = dfsph(
        2,
        &[
            "colliders=[]",
            "domain={\"min\":[0,0],\"max\":[2,1.6]}",
            "fluid.spacing=0.025",
            "fluid.viscosity=0",
            "bodies=[{\"shape\":{\"kind\":\"box\",\"min\":[0.6,0.033],\"max\":[1.4,0.833]},\"velocity\":[0,-1]}]",
            "gravity=[0,-9.81]",
            "time={\"duration\":0.2,\"fps\":100}",
        ],
    );
    let (_, frames) = frames(&scene, 20);
    let most = frames.iter().map(energy).fold(f64::MIN, f64::max);
    let fallen = energy(&frames[0]);
    assert!(most < 1.01 * fallen, "{most} J of {fallen} J");
    let last = frames[20].statistics.expect("statistics");
    let [mean, _] = last.density_error.expect("a fluid's");
    assert!(mean < 0.1, "{mean}");
}

/// A drop falls into a narrow column of water that is fifty particles deep, which it sets in motion as a whole.
#[test]
fn a_splash_in_deep_water_gives_no_energy() {
    let scene = dfsph(
        2,
        &[
            "colliders=[]",
            "domain={\"min\":[0,0],\"max\":[0.3,2]}",
            "fluid.spacing=0.02",
            "fluid.max_speed=5",
            "fluid.viscosity=0",
            "bodies=[{\"shape\":{\"kind\":\"box\",\"min\":[0,0],\"max\":[0.3,1]}},{\"shape\":{\"kind\":\"sphere\",\"center\":[0.12,1.2],\"radius\":0.09}}]",
            "gravity=[0,-9.81]",
            "time={\"duration\":0.8,\"fps\":20}",
        ],
    );
    let (_, frames) = frames(&scene, 16);
    let energies: Vec<f64> = frames.iter().map(energy).collect();
    let most = energies.iter().copied().fold(f64::MIN, f64::max);
    assert!(most < 1.005 * energies[0], "{energies:?} J");
    // Densities need no loop that goes through the whole column, again and again.
    let count = |frame: &Frame| convergence(frame).density_iterations;
    let steps: u32 = frames.iter().map(|frame| convergence(frame).steps).sum();
    let iterations: u32 = frames.iter().map(count).sum();
    assert!(iterations < 2 * steps, "{iterations} in {steps} steps");
}

fn still_water(overrides: &[&str]) -> Scene {
    let text = include_str!("../../assets/scenes/still_water.json");
    let all = [&["fluid.solver=dfsph", "time.fps=1"], overrides].concat();
    load::parse(
        text,
        "still_water",
        Path::new("."),
        &all.into_iter().map(str::to_owned).collect::<Vec<_>>(),
    )
    .expect("a scene")
}

/// Steps that its pressure cannot follow would throw it about.
#[test]
fn deep_water_stays_at_rest_whatever_steps_a_scene_allows() {
    let scene = still_water(&["fluid.courant_number=1", "time.duration=2"]);
    let (_, frames) = frames(&scene, 2);
    let fastest = frames[2].statistics.expect("statistics").max_speed;
    assert!(fastest < 1e-3, "{fastest} of √(gH)");
}

#[test]
fn deep_water_at_rest_has_the_pressure_of_the_column_above() {
    let scene = still_water(&["time.duration=5"]);
    let (simulation, frames) = frames(&scene, 5);
    let particles = simulation.particles().expect("particles");
    let pressures = simulation.pressures().expect("pressures");
    let count = pressures.len() as f64;
    // Height of the surface, gravity and density are 1 m, 1 m/s² and 1000 kg/m³.
    let height = |p: &Vec3| p.as_dvec3().y + scene.origin.y;
    let wrong = |(p, pressure): (&Vec3, &f32)| (f64::from(*pressure) - 1000.0 * (1.0 - height(p))).abs();
    let error = particles.position.iter().zip(&pressures).map(wrong).sum::<f64>() / count / 1000.0;
    assert!(error < 1e-3, "pressure is off by {error} of that on the floor");
    let mean = particles.position.iter().map(height).sum::<f64>() / count;
    assert!((mean - 0.5).abs() < 1e-3, "mean height {mean} m");
    let fastest = frames[5].statistics.expect("statistics").max_speed;
    assert!(fastest < 1e-3, "{fastest} of √(gH)");
}
