//! Fluids in hard cases, and what they keep.

use glam::{DVec3, Vec3};
use sliceflow::error::{Error, Result};
use sliceflow::guards::GuardKind;
use sliceflow::plan::Wanted;
use sliceflow::scene::{Particles, column, library, load};
use sliceflow::simulation::frame::Values;

use super::{particles, simulated, stirred};
use crate::common;

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
