//! A gas of elastic grains in a box: what the integrator does to its energy.

use glam::{DVec3, Vec3};
use rand::{Rng as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

use super::Case;
use crate::error::Result;
use crate::scene::Scene;
use crate::scene::model::Integrator;
use crate::study::Size;
use crate::study::accuracy::cases::columns::vectors;
use crate::study::accuracy::cases::dem::{frequency, grains, method, with_steps};
use crate::study::accuracy::published;
use crate::study::accuracy::record::{Bar, Figure, Record};
use crate::study::accuracy::run::{Run, run};
use crate::study::accuracy::theory::collision::Collision;
use crate::study::bench::Bench;
use crate::study::scenes;

pub const CASE: Case = Case {
    name: "gas",
    title: "Energy of an elastic gas",
    about: "64 grains fly about in a box whose walls are springs too, without any loss, until some 400 pairs have \
            collided. Energy of motion and of all springs is summed on the host in f64. The figure is the drift from \
            the start to the mean of the last tenth, over the energy at the start: root of the mean square of several \
            such gases.",
    resolution: "steps per contact",
    label: |steps| steps.to_string(),
    resolutions: |size| match size {
        Size::Tiny => &[20, 50],
        Size::Small => &[20, 50, 100, 200],
        Size::Full => &[20, 50, 100, 200, 500, 1000],
    },
    figure: FIGURE,
    published: published::ELASTIC_GAS,
    run: both_integrators,
};

const FIGURE: &str = "energy drift";
/// Grains along a side of the box, voxels a grain.
const SIDE: u32 = 4;
const ROOM: u32 = 2;
/// Largest speed along an axis, m/s.
const SPEED: f32 = 0.5;

/// Gases, and frames of each; a frame is a quarter of a contact.
fn extent(size: Size) -> (u64, u32) {
    match size {
        Size::Tiny => (1, 40),
        Size::Small => (4, 600),
        Size::Full => (16, 600),
    }
}

fn both_integrators(bench: &Bench, size: Size, steps: u32) -> Result<Vec<Record>> {
    let integrators = [Integrator::SymplecticEuler, Integrator::VelocityVerlet];
    integrators
        .into_iter()
        .map(|integrator| record(bench, size, integrator, steps))
        .collect()
}

fn record(bench: &Bench, size: Size, integrator: Integrator, steps: u32) -> Result<Record> {
    let (gases, frames) = extent(size);
    let mut whole = Run::default();
    let (mut squares, mut collisions) = (0.0, 0);
    for seed in 0..gases {
        let scene = gas(integrator, seed, steps, frames)?;
        let mut energies = Vec::new();
        let mut touching: Vec<(usize, usize)> = Vec::new();
        let one = run(bench, &scene, &["position", "velocity"], |frame| {
            let position = vectors(frame, "position");
            let (energy, pairs) = energy(&scene, &position, &vectors(frame, "velocity"));
            energies.push(energy);
            collisions += pairs.iter().filter(|pair| !touching.contains(pair)).count();
            touching = pairs;
        })?;
        let last = &energies[energies.len() - energies.len().div_ceil(10)..];
        let end = last.iter().sum::<f64>() / last.len() as f64;
        squares += (end / energies[0] - 1.0).powi(2);
        whole = whole.with(one);
    }
    let gases = gases as f64;
    let mut figure = Figure::new(
        FIGURE,
        whole.diverged.is_none().then_some((squares / gases).sqrt()),
        "",
    );
    if let Some(best) = published::ELASTIC_GAS[0].error_at(steps) {
        figure = figure
            .bar(Bar::AtMost(best))
            .best(best, published::ELASTIC_GAS[0].method);
    }
    let figures = vec![
        figure,
        Figure::new("collisions of a gas", collisions as f64 / gases, ""),
    ];
    Ok(whole.record(
        bench,
        CASE.name,
        method(integrator),
        steps,
        2.0 * scenes::RADIUS,
        figures,
    ))
}

/// Grains on a lattice with random velocities, without contacts.
fn gas(integrator: Integrator, seed: u64, steps: u32, frames: u32) -> Result<Scene> {
    let mut file = scenes::base("gas", [SIDE * ROOM; 3]);
    file["gravity"] = serde_json::json!([0, 0, 0]);
    file["grains"]["restitution"] = 1.into();
    file["grains"]["shear"] = 0.into();
    let mut particles = scenes::lattice([SIDE * ROOM; 3], |voxel| {
        voxel.as_uvec3() % ROOM == glam::UVec3::ZERO
    });
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    for velocity in &mut particles.velocity {
        *velocity = Vec3::from([(); 3].map(|()| random.random_range(-SPEED..SPEED)));
    }
    // Away from the walls, which the lattice stands at.
    for position in &mut particles.position {
        *position += Vec3::splat(scenes::RADIUS as f32);
    }
    let mut scene = scenes::with_particles(&file, particles)?;
    let contact = Collision {
        restitution: 1.0,
        frequency: frequency(&scene),
        speed: 1.0,
    };
    scene.time.integrator = integrator;
    let a_frame = (steps / 4).max(1);
    Ok(with_steps(
        scene,
        contact.duration() / f64::from(steps),
        a_frame,
        frames,
    ))
}

/// Joules of motion and of all springs, and the pairs that touch. Positions in the scene's own coordinates.
fn energy(scene: &Scene, position: &[DVec3], velocity: &[DVec3]) -> (f64, Vec<(usize, usize)>) {
    let grains = grains(scene);
    let spring = |overlap: f64| 0.5 * grains.contact.spring * overlap.max(0.0).powi(2);
    let motion: f64 = velocity
        .iter()
        .map(|v| 0.5 * grains.mass * v.length_squared())
        .sum();
    let [min, max] = [scene.domain.min, scene.domain.max].map(|corner| corner.as_dvec3() + scene.origin);
    let mut springs = 0.0;
    let mut touching = Vec::new();
    for (i, a) in position.iter().enumerate() {
        for wall in [*a - min, max - *a].iter().flat_map(|away| away.to_array()) {
            springs += spring(grains.radius - wall);
        }
        for (j, b) in position.iter().enumerate().skip(i + 1) {
            let overlap = 2.0 * grains.radius - a.distance(*b);
            if overlap > 0.0 {
                springs += spring(overlap);
                touching.push((i, j));
            }
        }
    }
    (motion + springs, touching)
}
