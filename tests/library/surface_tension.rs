//! Drops: how they ring, what their surface presses, how they meet walls.

use glam::Vec3;
use sliceflow::plan::Wanted;
use sliceflow::scene::Scene;
use sliceflow::simulation::Simulation;

use crate::common;

/// A drop of density 1 and surface tension 1 that starts as a box, without weight.
fn drop(body: &str, overrides: &[&str]) -> Scene {
    let body = format!("bodies=[{{\"shape\":{body}}}]");
    let mut all = vec![
        "colliders=[]",
        "domain.min=[-2,-2]",
        "domain.max=[2,2]",
        "gravity=[0,0]",
        "fluid.spacing=0.1",
        "fluid.density=1",
        "fluid.viscosity=0.05",
        "fluid.max_speed=1",
        "fluid.surface_tension=1",
        "fluid.negative_pressure=keep",
        "time.fps=10",
        body.as_str(),
    ];
    all.extend(overrides);
    common::fluid(2, &all)
}

fn each_frame(scene: &Scene, mut look: impl FnMut(&Simulation)) {
    let mut simulation = common::simulate(scene, &Wanted::default());
    for _ in 0..scene.time.frames {
        simulation.next_frame().unwrap_or_else(|error| panic!("{error}"));
        while simulation
            .finish_frame()
            .unwrap_or_else(|error| panic!("{error}"))
            .is_some()
        {}
        look(&simulation);
    }
}

/// Mean square of the ways from the middle, along x and along y.
fn spread(positions: &[Vec3]) -> [f32; 2] {
    let middle = positions.iter().sum::<Vec3>() / positions.len() as f32;
    let sum = positions.iter().map(|&x| (x - middle).powf(2.0)).sum::<Vec3>();
    [sum.x / positions.len() as f32, sum.y / positions.len() as f32]
}

/// A drop of radius R rings with ω² = 6σ/ρR³ in its lowest mode (Rayleigh 1879, in 2D), and its surface presses σ/R.
#[test]
fn a_drop_rings_and_presses() {
    let scene = drop(
        "{\"kind\":\"box\",\"min\":[-1,-0.8],\"max\":[1,0.8]}",
        &["domain.walls=open", "domain.sides={}", "time.duration=6"],
    );
    let (mut shapes, mut pressures) = (Vec::new(), Vec::new());
    each_frame(&scene, |simulation| {
        let found = simulation.particles().expect("particles");
        let [x, y] = spread(&found.position);
        shapes.push((x / y).ln());
        let pressure = simulation.pressures().expect("pressures");
        let inside = found
            .position
            .iter()
            .zip(&pressure)
            .filter(|(x, _)| x.length() < 0.5);
        let inside: Vec<f32> = inside.map(|(_, &p)| p).collect();
        pressures.push(f64::from(inside.iter().sum::<f32>()) / inside.len() as f64);
    });
    let crossings: Vec<f64> = shapes
        .windows(2)
        .enumerate()
        .filter(|(_, pair)| pair[0] * pair[1] < 0.0)
        .map(|(i, pair)| (i as f64 + f64::from(pair[0] / (pair[0] - pair[1]))) / scene.time.fps)
        .collect();
    assert!(crossings.len() >= 4, "it rings: {shapes:?}");
    let period = 2.0 * (crossings[3] - crossings[0]) / 3.0;
    let radius = (4.0 * 0.8 / std::f64::consts::PI).sqrt();
    let exact = std::f64::consts::TAU / (6.0 / radius.powi(3)).sqrt();
    assert!(
        (period / exact - 1.0).abs() < 0.1,
        "{period} s instead of {exact} s"
    );
    // From the end of the first ring on.
    let late = &pressures[20..];
    let pressure = late.iter().sum::<f64>() / late.len() as f64;
    assert!(
        (pressure * radius - 1.0).abs() < 0.3,
        "{pressure} Pa instead of {}",
        1.0 / radius
    );
}

/// A drop on a floor that it meets at the angle θ is 2 / tan(θ/2) times as wide as high.
#[test]
fn drops_meet_walls_at_their_angle() {
    let angles = [(60.0, 3.46), (90.0, 2.0), (120.0, 1.15)];
    for (walls, angles) in [("particles", &angles[..]), ("planes", &angles[..1])] {
        let mut last = f32::INFINITY;
        for (angle, exact) in angles {
            let walls = format!("domain.walls={walls}");
            let angle = format!("fluid.contact_angle={angle}");
            let scene = drop(
                "{\"kind\":\"box\",\"min\":[-0.8,-2],\"max\":[0.8,-1.2]}",
                &[
                    &walls,
                    &angle,
                    "time.duration=5",
                    "time.fps=1",
                    "fluid.viscosity=0.3",
                ],
            );
            let mut positions = Vec::new();
            each_frame(&scene, |simulation| {
                positions = simulation.particles().expect("particles").position;
            });
            let half = 0.05;
            let of = |pick: fn(&Vec3) -> f32| {
                let mut all: Vec<f32> = positions.iter().map(pick).collect();
                all.sort_by(f32::total_cmp);
                (all[0], all[all.len() - 1])
            };
            let (left, right) = of(|x| x.x);
            let (_, top) = of(|x| x.y);
            let ratio = (right - left + 2.0 * half) / (top + 2.0 + half);
            assert!(ratio < last, "{walls} {angle}: {ratio} is not less than {last}");
            assert!(
                (ratio / exact - 1.0).abs() < 0.15,
                "{walls} {angle}: {ratio} instead of {exact}"
            );
            last = ratio;
        }
    }
}
