//! What walls do to fluids.

use glam::Vec3;

use super::particles;
use crate::common;

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

/// A block is thrown at a wall ten times as fast as expected, faster than pressure can stop it: it ends at the wall's face, and
/// goes along it.
#[test]
fn what_pressure_cannot_stop_stops_at_the_face() {
    for solver in ["sph", "wcsph", "dfsph"] {
        for walls in ["particles", "planes"] {
            if (solver, walls) == ("dfsph", "planes") {
                continue;
            }
            let overrides = [
                &*format!("fluid.solver={solver}"),
                &*format!("domain.walls={walls}"),
                "colliders=[]",
                "time.adaptive=true",
                "bodies[0].velocity=[-10,2]",
                r#"bodies[0].shape={"kind":"box","min":[0.3,0.1],"max":[0.6,0.4]}"#,
            ];
            let scene = common::fluid(2, &overrides);
            let found = particles(&scene, 1);
            let (low, high) = (scene.domain.min - 1e-6, scene.domain.max + 1e-6);
            for x in &found.position {
                assert!(
                    x.cmpge(low).all() && x.cmple(high).all(),
                    "{solver}, {walls}: {x}"
                );
            }
        }
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
