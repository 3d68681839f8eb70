//! Fluids against f64 on the CPU, through every grid, and in hard cases.

mod common;
#[path = "common/fluid_reference.rs"]
mod fluid_reference;

use fluid_reference::Reference;
use glam::{DVec3, Vec3};
use sliceflow::error::{Error, Result};
use sliceflow::guards::GuardKind;
use sliceflow::plan::Wanted;
use sliceflow::scene::{Particles, Scene, column, library, load};
use sliceflow::simulation::Simulation;
use sliceflow::simulation::frame::Values;

/// Simulates `frames` frame intervals.
fn simulated(scene: &Scene, frames: u32) -> Simulation {
    let mut simulation = common::simulate(scene, &Wanted::default());
    for _ in 0..=frames {
        simulation.next_frame().unwrap_or_else(|error| panic!("{error}"));
    }
    while simulation
        .finish_frame()
        .unwrap_or_else(|error| panic!("{error}"))
        .is_some()
    {}
    simulation
}

fn particles(scene: &Scene, frames: u32) -> Particles {
    simulated(scene, frames).particles().expect("particles")
}

/// Fluid thrown about a little, so that every term counts. A frame has `steps` steps.
fn stirred(dimensions: usize, steps: u32, overrides: &[&str]) -> Scene {
    let mut scene = common::fluid(dimensions, overrides);
    let spacing = scene.fluid().expect("a fluid").spacing as f32;
    for (k, (x, v)) in scene
        .particles
        .position
        .iter_mut()
        .zip(&mut scene.particles.velocity)
        .enumerate()
    {
        let wave = Vec3::new(
            (k as f32 * 1.7).sin(),
            (k as f32 * 2.3).cos(),
            (k as f32 * 3.1).sin(),
        );
        let wave = if dimensions == 2 { wave.with_z(0.0) } else { wave };
        *x += 0.1 * spacing * wave;
        *v += 0.3 * Vec3::new(wave.y, wave.x, wave.z);
    }
    scene.time.steps_per_frame = steps;
    scene.time.fps = 1.0 / (f64::from(steps) * scene.time.step);
    scene
}

const SOLVERS: [&[&str]; 14] = [
    &[],
    &["fluid.viscosity=5"],
    &[
        "time.integrator=velocity_verlet",
        "fluid.viscosity=5",
        "fluid.viscosity_form=laplacian",
    ],
    &["fluid.solver=sph", "fluid.viscosity=5"],
    &[
        "fluid.density_from=summation",
        "fluid.pressure_force=monaghan",
        "fluid.kernel=cubic_spline",
    ],
    &[
        "fluid.negative_pressure=control",
        "fluid.artificial_viscosity=0.2",
        "fluid.kernel=wendland_c4",
    ],
    &["fluid.artificial_viscosity=0.2", "fluid.slip=free_slip"],
    &[
        "fluid.shifting=1",
        "fluid.slip=free_slip",
        "fluid.wall_friction=0.2",
    ],
    &[
        "fluid.viscosity=5",
        "fluid.viscosity_form=stress",
        "fluid.slip=free_slip",
    ],
    &[
        "fluid.viscosity=5",
        "fluid.viscosity_form=laplacian",
        "fluid.gradient_correction=true",
        "fluid.pressure_force=difference",
        "fluid.shifting=1",
        "fluid.negative_pressure=keep",
    ],
    &[
        "fluid.viscosity=5",
        "fluid.viscosity_form=laplacian",
        "fluid.gradient_correction=true",
    ],
    &[
        "fluid.viscosity=5",
        "fluid.viscosity_form=stress",
        "fluid.gradient_correction=true",
        "fluid.pressure_force=difference",
        "fluid.shifting=1",
        "fluid.kernel=quintic_spline",
        "fluid.negative_pressure=keep",
    ],
    &[
        "fluid.materials=[{\"name\":\"water\",\"density\":1000,\"viscosity\":3},\
         {\"name\":\"oil\",\"density\":500,\"viscosity\":10,\"surface_tension\":10}]",
        "fluid.negative_pressure=keep",
        "fluid.background_pressure=2000",
    ],
    &["fluid.surface_tension=20", "fluid.contact_angle=60"],
];

#[test]
fn every_solver_follows_the_reference_in_f64() {
    for dimensions in [2, 3] {
        for (row, solver) in SOLVERS.into_iter().enumerate() {
            // Each solver meets both kinds of sides, one of them in 2D and one in 3D.
            let walls = ["domain.walls=particles", "domain.walls=periodic"][(row + dimensions) % 2];
            let bodies = match dimensions {
                2 => "bodies=[{\"shape\":{\"kind\":\"box\",\"min\":[0,0],\"max\":[0.3,0.25]}}]",
                _ => "bodies=[{\"shape\":{\"kind\":\"box\",\"min\":[0,0,0],\"max\":[0.15,0.15,0.2]}}]",
            };
            let mut overrides = solver.to_vec();
            overrides.extend([walls, bodies]);
            let mut scene = stirred(dimensions, 10, &overrides);
            if scene.fluid().is_some_and(|fluid| fluid.materials.len() == 2) {
                for (k, material) in scene.particles.material.iter_mut().enumerate() {
                    *material = k as u32 % 2;
                }
            }
            let mut reference = Reference::new(&scene);
            for _ in 0..10 {
                reference.advance();
            }
            let simulation = simulated(&scene, 1);
            let found = simulation.particles().expect("particles");
            let pressures = simulation.pressures().expect("pressures");
            let fluid = scene.fluid().expect("a fluid");
            let stiffness = fluid.materials[0].density * fluid.sound_speed.powi(2);
            let travelled = fluid.max_speed * 10.0 * scene.time.step;
            for (i, &pressure) in pressures.iter().enumerate() {
                let told = format!("{dimensions}D {overrides:?}, particle {i}");
                let moved = (found.position[i].as_dvec3() - reference.position[i]).length();
                let moved = moved.min((moved - scene.domain.period().max_element() as f64).abs());
                assert!(moved < 1e-4 * travelled, "{told}: position off by {moved}");
                let sped = (found.velocity[i].as_dvec3() - reference.velocity[i]).length();
                assert!(sped < 2e-4 * fluid.max_speed, "{told}: velocity off by {sped}");
                let pressed = (f64::from(pressure) - reference.pressure[i]).abs();
                assert!(pressed < 1e-5 * stiffness, "{told}: pressure off by {pressed}");
            }
        }
    }
}

#[test]
fn every_grid_gives_the_same_flow() {
    for dimensions in [2, 3] {
        let mut expected: Option<Particles> = None;
        let grids = if dimensions == 2 {
            common::grids_in_turn(0)
        } else {
            common::grids_by_query()
        };
        for (addressing, storage) in grids {
            let skins: &[&str] = match (storage.sorts, dimensions) {
                // Lists are made of particles in order.
                (false, _) => &["0"],
                (true, 2) => &["0.1"],
                (true, _) => &["0", "0.1"],
            };
            for skin in skins {
                let (addressing, storage) = (addressing.name, storage.name);
                let grid = [
                    format!("neighbors.addressing={addressing}"),
                    format!("neighbors.storage={storage}"),
                    format!("neighbors.skin={skin}"),
                ];
                let mut overrides: Vec<&str> = grid.iter().map(String::as_str).collect();
                overrides.extend(["neighbors.slots=64", "fluid.artificial_viscosity=0.2"]);
                let found = particles(&stirred(dimensions, 20, &overrides), 1);
                let expected = expected.get_or_insert_with(|| found.clone());
                for (i, (a, b)) in found.velocity.iter().zip(&expected.velocity).enumerate() {
                    let off = a.distance(*b);
                    assert!(
                        off < 1e-3,
                        "{dimensions}D {grid:?}: velocity of {i} off by {off} m/s"
                    );
                }
            }
        }
    }
}

#[test]
fn a_single_particle_falls_freely() {
    let mut scene = common::fluid(
        2,
        &[
            "bodies=[{\"shape\":{\"kind\":\"box\",\"min\":[0,0],\"max\":[0.05,0.05]}}]",
            "colliders=[]",
            "domain.walls=open",
        ],
    );
    scene.particles.position[0] = Vec3::new(0.0, 0.2, 0.0);
    let found = particles(&scene, 1);
    let (steps, step) = (f64::from(scene.time.steps_per_frame), scene.time.step);
    // Symplectic Euler: v = g n Δt, y = y₀ + g Δt² n (n + 1) / 2.
    let (v, y) = (-steps * step, 0.2 - step * step * steps * (steps + 1.0) / 2.0);
    assert!((f64::from(found.velocity[0].y) - v).abs() < 1e-6);
    assert!((f64::from(found.position[0].y) - y).abs() < 1e-6);
    assert_eq!(found.density_deviation[0], 0.0);
}

/// Pairs push and pull each other equally, and periodic sides take nothing away.
#[test]
fn momentum_stays() {
    for solver in [
        &["fluid.viscosity=5"][..],
        &["fluid.viscosity=5", "fluid.viscosity_form=stress"],
    ] {
        let mut overrides = vec![
            "domain.walls=periodic",
            "gravity=[0,0]",
            "colliders=[]",
            "fluid.negative_pressure=keep",
        ];
        overrides.extend(solver);
        overrides.push("bodies=[{\"shape\":{\"kind\":\"box\",\"min\":[0,0],\"max\":[1,0.5]}}]");
        let scene = stirred(2, 50, &overrides);
        let total = |velocities: &[Vec3]| velocities.iter().map(|v| v.as_dvec3()).sum::<DVec3>();
        let before = total(&scene.particles.velocity);
        let found = particles(&scene, 1);
        let speeds: f64 = found.velocity.iter().map(|v| f64::from(v.length())).sum();
        let change = (total(&found.velocity) - before).length();
        assert!(change < 1e-4 * speeds, "{solver:?}: {change} of {speeds}");
    }
}

/// Two compressed particles that have left the fluid do not push each other away; a compressed block swells.
#[test]
fn drops_are_under_the_airs_pressure() {
    for (side, height, bottom, swells) in [(2, 1, 0.2, false), (8, 8, 0.05, true)] {
        let (right, top) = (0.3 + 0.05 * f64::from(side), bottom + 0.05 * f64::from(height));
        let body = format!(
            "bodies=[{{\"shape\":{{\"kind\":\"box\",\"min\":[0.3,{bottom}],\"max\":[{right},{top}]}}}}]"
        );
        let mut scene = common::fluid(2, &[&body, "colliders=[]", "gravity=[0,0]", "time.fps=200"]);
        let count = scene.first_boundary() as usize;
        assert_eq!(count, if swells { 64 } else { 2 });
        scene.particles.density_deviation[..count].fill(0.01);
        let found = particles(&scene, 1);
        let fastest = found.velocity.iter().map(|v| v.length()).fold(0.0, f32::max);
        assert_eq!(fastest > 0.0, swells, "{count} particles: {fastest} m/s");
    }
}

#[test]
fn clamping_is_counted() {
    for (kept, clamps) in [("clamp", true), ("keep", false)] {
        let negative = format!("fluid.negative_pressure={kept}");
        let scene = stirred(2, 200, &[&negative, "fluid.viscosity=1"]);
        let wanted = Wanted {
            statistics: true,
            columns: vec![column::find("pressure").expect("a column")],
            columns_every: 1,
            ..Wanted::default()
        };
        let mut simulation = common::simulate(&scene, &wanted);
        for _ in 0..2 {
            simulation.next_frame().expect("a frame");
        }
        let mut last = None;
        while let Some(frame) = simulation.finish_frame().expect("a frame") {
            last = Some(frame);
        }
        let frame = last.expect("a frame");
        let Values::Float(pressure) = &frame.columns[0].values else {
            panic!("pressure is one number a particle");
        };
        let at_zero = pressure.iter().filter(|p| **p == 0.0).count();
        match frame.statistics.expect("statistics").clamped {
            Some([pressures, densities]) => {
                assert!(clamps);
                assert_eq!(pressures as usize, at_zero);
                assert!(
                    0 < densities && densities < pressures,
                    "{densities} of {pressures}"
                );
            }
            None => assert!(!clamps && at_zero == 0),
        }
    }
}

/// A dam breaks, sloshes and comes to rest; nothing leaks through walls, the guard would tell.
#[test]
fn nothing_leaks() {
    for (slip, walls) in [
        ("no_slip", "particles"),
        ("free_slip", "particles"),
        ("no_slip", "planes"),
    ] {
        let (slip, walls) = (format!("fluid.slip={slip}"), format!("domain.walls={walls}"));
        let overrides = [
            slip.as_str(),
            walls.as_str(),
            "fluid.viscosity=1",
            "fluid.artificial_viscosity=0.05",
            "time.fps=1",
            "time.duration=6",
        ];
        let scene = common::fluid(2, &overrides);
        let found = particles(&scene, scene.time.frames - 1);
        let half = scene.radius() as f32;
        for x in &found.position {
            assert!(x.cmpge(scene.domain.min - 0.2 * half).all(), "{x}");
            assert!(x.cmple(scene.domain.max + 0.2 * half).all(), "{x}");
        }
        let fastest = found.velocity.iter().map(|v| v.length()).fold(0.0, f32::max);
        assert!(fastest < 0.2, "after six seconds still {fastest} m/s");
    }
}

/// A layer slides over the floor: walls along which it slips take nothing of its speed, others do.
#[test]
fn walls_that_slip_do_not_brake() {
    for walls in ["particles", "planes"] {
        for (slip, kept) in [("free_slip", 0.98..1.001), ("no_slip", 0.0..0.8)] {
            let (walls, slip) = (format!("domain.walls={walls}"), format!("fluid.slip={slip}"));
            let scene = common::fluid(
                2,
                &[
                    walls.as_str(),
                    slip.as_str(),
                    "colliders=[]",
                    "domain.sides={\"x_min\":\"periodic\",\"x_max\":\"periodic\"}",
                    "fluid.artificial_viscosity=0.2",
                    "fluid.max_speed=2",
                    "bodies=[{\"shape\":{\"kind\":\"box\",\"min\":[0,0],\"max\":[1,0.2]},\
                     \"velocity\":[1,0],\"pressure\":\"hydrostatic\"}]",
                    "time.duration=1",
                    "time.fps=1",
                ],
            );
            let found = particles(&scene, 1);
            let speed = found.velocity.iter().map(|v| v.x).sum::<f32>() / found.len() as f32;
            assert!(kept.contains(&speed), "{walls}, {slip}: {speed} of 1 m/s is left");
        }
    }
}

/// A layer of depth h over a floor with friction: dv/dt = −c v² / 2h, so v = v₀ / (1 + c v₀ t / 2h).
#[test]
fn friction_brakes_by_the_square_of_the_speed() {
    for (dimensions, walls) in [(2, "particles"), (2, "planes"), (3, "particles")] {
        for friction in [0.02, 0.1] {
            let (walls, friction_key) = (
                format!("domain.walls={walls}"),
                format!("fluid.wall_friction={friction}"),
            );
            let (sides, body) = match dimensions {
                2 => (
                    "domain.sides={\"x_min\":\"periodic\",\"x_max\":\"periodic\"}",
                    "bodies=[{\"shape\":{\"kind\":\"box\",\"min\":[0,0],\"max\":[1,0.2]},\
                     \"velocity\":[1,0],\"pressure\":\"hydrostatic\"}]",
                ),
                _ => (
                    "domain.sides={\"x_min\":\"periodic\",\"x_max\":\"periodic\",\
                     \"z_min\":\"periodic\",\"z_max\":\"periodic\"}",
                    "bodies=[{\"shape\":{\"kind\":\"box\",\"min\":[0,0,0],\"max\":[0.6,0.2,0.4]},\
                     \"velocity\":[1,0,0],\"pressure\":\"hydrostatic\"}]",
                ),
            };
            let time = if dimensions == 2 { 1.0 } else { 0.3 };
            let scene = common::fluid(
                dimensions,
                &[
                    walls.as_str(),
                    friction_key.as_str(),
                    sides,
                    body,
                    "fluid.slip=free_slip",
                    // The layer goes as one.
                    "fluid.viscosity=50",
                    "colliders=[]",
                    "fluid.max_speed=2",
                    &format!("time.duration={time}"),
                    &format!("time.fps={}", 1.0 / time),
                ],
            );
            let found = particles(&scene, 1);
            let speed = found.velocity.iter().map(|v| f64::from(v.x)).sum::<f64>() / found.len() as f64;
            let lost = 1.0 - 1.0 / (1.0 + friction * time / (2.0 * 0.2));
            let apart = (1.0 - speed) / lost - 1.0;
            assert!(
                apart.abs() < 0.1,
                "{dimensions}D {walls}, {friction}: lost {} of {lost} m/s",
                1.0 - speed
            );
        }
    }
}

/// Shifting spreads particles evenly and leaves a free surface where it is.
#[test]
fn shifting_keeps_to_the_surface() {
    let scene = |shifting: &str| {
        common::fluid(
            2,
            &[
                shifting,
                "fluid.slip=free_slip",
                "fluid.artificial_viscosity=0.1",
                "colliders=[]",
                "bodies=[{\"shape\":{\"kind\":\"box\",\"min\":[0,0],\"max\":[0.3,0.5]}}]",
                "time.duration=1",
                "time.fps=1",
            ],
        )
    };
    // How far particles are from their nearest neighbors, spacings: the worst hundredth.
    let closest = |found: &Particles, spacing: f32| {
        let mut least: Vec<f32> = found
            .position
            .iter()
            .enumerate()
            .map(|(i, a)| {
                let others = found.position.iter().enumerate().filter(|(j, _)| i != *j);
                others.map(|(_, b)| a.distance(*b)).fold(f32::MAX, f32::min) / spacing
            })
            .collect();
        least.sort_by(f32::total_cmp);
        least[least.len() / 100]
    };
    let height = |found: &Particles| found.position.iter().map(|x| x.y).sum::<f32>() / found.len() as f32;
    let [plain, shifted] = ["fluid.shifting=0", "fluid.shifting=1"].map(|shifting| {
        let scene = scene(shifting);
        let found = particles(&scene, 1);
        (closest(&found, 2.0 * scene.radius() as f32), height(&found))
    });
    assert!(
        shifted.0 > 1.1 * plain.0,
        "nearest neighbors: {} beside {}",
        shifted.0,
        plain.0
    );
    let rise = shifted.1 - plain.1;
    assert!(rise.abs() < 0.02, "the water's middle is {rise} m higher");
}

/// What comes down onto a floor that slips is pressed together and damped, by planes as by particles.
#[test]
fn walls_that_slip_press_and_damp_what_comes_nearer() {
    let met = |walls: &str| {
        let [(speed, pressed), (damped, _)] = ["0", "0.5"].map(|alpha| {
            let (walls, alpha) = (
                format!("domain.walls={walls}"),
                format!("fluid.artificial_viscosity={alpha}"),
            );
            let mut scene = common::fluid(
                2,
                &[
                    walls.as_str(),
                    alpha.as_str(),
                    "fluid.slip=free_slip",
                    "gravity=[0,0]",
                    "colliders=[]",
                    "domain.sides={\"x_min\":\"periodic\",\"x_max\":\"periodic\"}",
                    "bodies=[{\"shape\":{\"kind\":\"box\",\"min\":[0,0],\"max\":[1,0.2]},\"velocity\":[0.3,-0.3]}]",
                    "time.step=1e-4",
                ],
            );
            scene.time.steps_per_frame = 1;
            scene.time.fps = 1.0 / scene.time.step;
            let found = particles(&scene, 1);
            let lowest = found.position.iter().map(|x| x.y).fold(f32::MAX, f32::min);
            let floor = |i: &usize| found.position[*i].y < lowest + 0.01;
            let (x, y): (Vec<f32>, Vec<f32>) = (0..found.len())
                .filter(floor)
                .map(|i| (found.velocity[i].x, found.velocity[i].y))
                .unzip();
            assert!(x.iter().all(|x| (x - 0.3).abs() < 1e-4), "{walls}: {x:?}");
            let pressed = found.density_deviation.iter().fold(0.0, |most: f32, &e| most.max(e));
            (y.iter().sum::<f32>() / y.len() as f32, pressed)
        });
        [pressed, damped - speed]
    };
    let [particles, planes] = ["particles", "planes"].map(met);
    for (what, (particles, planes)) in ["pressed", "damped"]
        .iter()
        .zip(particles.into_iter().zip(planes))
    {
        assert!(particles > 1e-4, "{what}: {particles}");
        let apart = (planes / particles - 1.0).abs();
        assert!(apart < 0.2, "{what}: {planes} beside {particles}");
    }
}

/// What splashes higher than an open tank finds its sides there too.
#[test]
fn splashes_stay_above_their_tank() {
    for integrator in ["symplectic_euler", "velocity_verlet"] {
        let integrator = format!("time.integrator={integrator}");
        let mut scene = common::fluid(
            2,
            &[
                &integrator,
                "colliders=[]",
                "domain.sides={\"y_max\":\"open\"}",
                "time.duration=4",
                "time.fps=1",
                "fluid.max_speed=4",
            ],
        );
        let top = scene.domain.max;
        scene.particles.position[0] = Vec3::new(top.x - 0.1, top.y + 0.1, 0.0);
        scene.particles.velocity[0] = Vec3::new(2.0, 1.0, 0.0);
        let found = particles(&scene, 4);
        assert_ne!(found.position[0].x, scene.particles.position[0].x);
        assert!(found.position[0].x.abs() < top.x, "{}", found.position[0]);
    }
}

/// Light fluid above one twice as dense stays there.
#[test]
fn layers_of_different_density_rest() {
    let scene = common::fluid(
        2,
        &[
            "colliders=[]",
            "fluid.materials=[{\"name\":\"heavy\",\"density\":1000},{\"name\":\"light\",\"density\":500}]",
            "bodies=[{\"shape\":{\"kind\":\"box\",\"min\":[0,0],\"max\":[1,0.2]},\"material\":\"heavy\"},\
             {\"shape\":{\"kind\":\"box\",\"min\":[0,0.2],\"max\":[1,0.4]},\"material\":\"light\"}]",
            "fluid.artificial_viscosity=0.2",
            "time.duration=4",
            "time.fps=1",
        ],
    );
    let found = particles(&scene, scene.time.frames - 1);
    let mean = |material: u32| {
        let all = found.position.iter().zip(&scene.particles.material);
        let heights: Vec<f32> = all.filter(|(_, m)| **m == material).map(|(x, _)| x.y).collect();
        heights.iter().sum::<f32>() / heights.len() as f32
    };
    let (heavy, light) = (mean(0), mean(1));
    assert!((light - heavy - 0.2).abs() < 0.02, "{heavy} {light}");
    assert!(found.velocity.iter().all(|v| v.length() < 0.1));
}

/// A channel under a constant force: planes and boundary particles let the fluid stick at the same place.
#[test]
fn a_channel_has_its_parabola() {
    for walls in ["particles", "planes"] {
        let walls = format!("domain.walls={walls}");
        let scene = common::fluid(
            2,
            &[
                walls.as_str(),
                "colliders=[]",
                "domain.sides={\"x_min\":\"periodic\",\"x_max\":\"periodic\"}",
                "gravity=[8,0]",
                "domain.max=[0.5,1]",
                "fluid.density=1",
                "fluid.viscosity=1",
                "fluid.kernel=quintic_spline",
                "fluid.negative_pressure=keep",
                "bodies=[{\"shape\":{\"kind\":\"box\",\"min\":[0,0],\"max\":[0.5,1]}}]",
                "time.duration=1",
                "time.fps=1",
            ],
        );
        let found = particles(&scene, 1);
        for (x, v) in found.position.iter().zip(&found.velocity) {
            // 4 y (1 − y) with y from the middle of the channel; at t = 1 the start has died away.
            let exact = 1.0 - 4.0 * x.y * x.y;
            assert!((v.x - exact).abs() < 0.006, "{walls}: {} at {}", v.x, x.y);
            assert!(v.y.abs() < 1e-3, "{walls}");
        }
    }
}

/// A run that goes on from a state is the same run, to the bit.
#[test]
fn a_run_goes_on_from_its_state() {
    for (dimensions, choice) in [
        (2, "fluid.viscosity=5"),
        (2, "time.integrator=velocity_verlet"),
        (3, "fluid.density_from=summation"),
        (
            2,
            "fluid.materials=[{\"name\":\"a\",\"density\":1000},{\"name\":\"b\",\"density\":500}]",
        ),
    ] {
        let scene = stirred(
            dimensions,
            12,
            &[
                choice,
                "domain.sides={\"x_min\":\"periodic\",\"x_max\":\"periodic\"}",
            ],
        );
        let whole = particles(&scene, 3);
        let state = simulated(&scene, 1).save_state().expect("a state");
        let mut later = common::simulate(&scene, &Wanted::default());
        later.restore(&state).expect("restored");
        for _ in 0..2 {
            later.next_frame().unwrap_or_else(|error| panic!("{error}"));
        }
        while later.finish_frame().expect("a frame").is_some() {}
        assert_eq!(
            later.particles().expect("particles"),
            whole,
            "{dimensions}D {choice}"
        );
    }
}

/// A jet fills a tank: what is let in keeps its speed on the way and its volume at rest.
#[test]
fn a_jet_fills_a_tank() {
    let scene = common::fluid(
        2,
        &[
            "colliders=[]",
            "bodies=[]",
            "fluid.artificial_viscosity=0.1",
            "emitters=[{\"name\":\"tap\",\"center\":[0.5,0.4],\"radius\":0.1,\"velocity\":[0,-0.5]}]",
            "events=[{\"at\":2,\"emitter\":{\"name\":\"tap\",\"on\":false}}]",
            "time.duration=6",
            "time.fps=1",
        ],
    );
    let emitted = scene.first_boundary() as f64;
    assert_eq!(emitted, 60.0, "three a layer, twenty layers of 0.05 m in 2 s");
    let found = particles(&scene, scene.time.frames - 1);
    assert_eq!(found.len() as f64, emitted);
    let spread =
        found.density_deviation.iter().map(|e| e.abs()).sum::<f32>() / found.density_deviation.len() as f32;
    assert!(spread < 0.02, "density varies by {spread} on average");
    // Half of it lies below the height that all of it fills.
    let height = emitted * scene.fluid().expect("a fluid").volume(scene.dimensions);
    let mut heights: Vec<f32> = found.position.iter().map(|x| x.y - scene.domain.min.y).collect();
    heights.sort_by(f32::total_cmp);
    let middle = f64::from(heights[heights.len() / 2]);
    assert!(
        middle < height,
        "half lies above {middle} m, all fills {height} m"
    );
}

/// Nothing acts on a square that turns in the air: energy and angular momentum stay, its particles stay apart and together.
#[test]
fn a_square_that_turns_stays_whole() {
    let text = library::find("rotating_square").expect("a scene that ships");
    let overrides = ["fluid.spacing=0.05", "time.duration=1", "time.fps=1"].map(str::to_owned);
    let scene = load::parse(text, "test.json", &library::folder().unwrap(), &overrides).unwrap();
    let spacing = 2.0 * scene.radius() as f32;
    let sums = |position: &[Vec3], velocity: &[Vec3]| {
        let both = position.iter().zip(velocity);
        let turn = both.map(|(x, v)| f64::from(x.x * v.y - x.y * v.x)).sum::<f64>();
        let energy = velocity
            .iter()
            .map(|v| f64::from(v.length_squared()))
            .sum::<f64>();
        [energy, turn]
    };
    let before = sums(&scene.particles.position, &scene.particles.velocity);
    let found = particles(&scene, 1);
    let after = sums(&found.position, &found.velocity);
    for (name, before, after) in [("energy", before[0], after[0]), ("momentum", before[1], after[1])] {
        let change = after / before - 1.0;
        assert!(change.abs() < 0.03, "{name} changed by {change}");
    }
    for (i, a) in found.position.iter().enumerate() {
        let others = found.position.iter().enumerate().filter(|(j, _)| i != *j);
        let nearest = others.map(|(_, b)| a.distance(*b)).fold(f32::MAX, f32::min) / spacing;
        assert!((0.5..1.5).contains(&nearest), "particle {i}: {nearest} spacings");
    }
}

/// A particle that is far faster than sound ends the run with an error that names it, before energies are no number.
#[test]
fn what_runs_away_ends_the_run() {
    let mut scene = common::fluid(2, &["domain.walls=open"]);
    let sound = scene.fluid().expect("a fluid").sound_speed as f32;
    for (speed, caught) in [
        (3.0 * sound, None),
        (20.0 * sound, Some(GuardKind::TooFast)),
        (120.0 * sound, Some(GuardKind::Runaway)),
    ] {
        scene.particles.velocity[3] = Vec3::new(0.0, speed, 0.0);
        let mut simulation = common::simulate(&scene, &Wanted::default());
        let mut run = || -> Result<()> {
            for _ in 0..2 {
                simulation.next_frame()?;
            }
            while simulation.finish_frame()?.is_some() {}
            Ok(())
        };
        match run() {
            Ok(()) => assert_eq!(caught, None),
            Err(Error::Guard(violation)) => {
                assert_eq!(Some(violation.guard), caught, "{violation}");
                assert_eq!(violation.particle.expect("a particle").id, 3);
            }
            Err(error) => panic!("{error}"),
        }
    }
}
