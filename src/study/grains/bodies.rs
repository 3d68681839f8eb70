//! Rigid bodies made of grains: momenta of a collision, a body that tumbles, a ball that rolls down a slope.

use serde_json::{Value, json};

use super::Scale;
use crate::error::Result;
use crate::output::plot::Plot;
use crate::physics::bodies::{BodyMotion, energies, momenta};
use crate::scene::Scene;
use crate::study::accuracy::run::run;
use crate::study::bench::Bench;
use crate::study::page::{Cell, Page, Table};
use crate::study::scenes;

const GRAVITY: f64 = 9.81;

pub fn bodies(page: &mut Page, bench: &Bench, scale: &Scale) -> Result<()> {
    page.heading("Rigid bodies made of particles");
    let mut table = Table::new(["what", "largest error", "bar"]);
    let mut row = |what: &str, error: f64, bar: f64| {
        table.row([Cell::text(what), Cell::number(error), Cell::number(bar)]);
    };
    bench.tell("grains: two bodies collide");
    let [linear, angular] = collision(bench)?;
    row(
        "momentum of an isolated collision, over that of the bodies",
        linear,
        1e-6,
    );
    row("angular momentum of it, over momentum times 0.3 m", angular, 1e-5);
    bench.tell("grains: a body tumbles");
    let [angular, energy] = tumbling(bench)?;
    row(
        "angular momentum of a body that tumbles about its middle axis",
        angular,
        1e-5,
    );
    row("energy of it", energy, 1e-5);
    page.table("bodies", &table);

    let restitutions = [1.0, 0.9];
    let mut table = Table::new([
        "spacing of particles, radii",
        "acceleration over 5/7 g sin θ, elastic",
        "with e = 0.9",
    ]);
    let mut found = [Vec::new(), Vec::new()];
    for &spacing in scale.spacings {
        bench.tell(&format!("grains: a ball covered {spacing} radii apart rolls"));
        let mut cells = vec![Cell::number(spacing)];
        for (series, restitution) in found.iter_mut().zip(restitutions) {
            let rolled = rolling(bench, spacing, restitution)?;
            series.push((spacing, rolled));
            cells.push(Cell::number(rolled));
        }
        table.row(cells);
    }
    page.table("bodies_rolling", &table);
    page.paragraph(
        "A ball of ten particle radii, covered by particles, rolls down a slope of 20° for 0.8 s; the bar of the elastic one is \
         1 %. Particles are bumps: as a polygon that rolls loses some speed on each side, so does a ball whose contacts are not \
         elastic, the more so the farther apart its particles are.",
    );
    let [elastic, damped] = found;
    let chart = Plot::new(
        "A covered ball on a slope",
        "spacing of particles, radii",
        "acceleration over 5/7 g sin θ",
    )
    .points("elastic", elastic)
    .points("e = 0.9", damped)
    .mark_y(1.0, "a smooth ball");
    page.picture(
        "grains_bodies_rolling.png",
        "Acceleration of a ball whose surface is made of particles.",
        |path| chart.save(path),
    )
}

/// The scene of these bodies, and how they move in each frame.
fn motions(bench: &Bench, file: &Value) -> Result<(Scene, Vec<Vec<BodyMotion>>)> {
    let scene = scenes::parse(file)?;
    let mut all = Vec::new();
    run(bench, &scene, &[], |frame| all.push(frame.bodies.clone()))?;
    Ok((scene, all))
}

fn space(bodies: Value, duration: f64) -> Value {
    json!({
        "name": "bodies",
        "domain": { "min": [-1, -1, -1], "max": [1, 1, 1], "walls": "open" },
        "gravity": [0, 0, 0],
        "grains": {
            "radius": 0.02, "density": 1000, "law": "linear", "contact_time": 2e-3, "restitution": 0.6, "friction": 0.4
        },
        "bodies": bodies,
        "time": { "duration": duration, "fps": 20 },
    })
}

/// Errors of momentum and angular momentum.
fn collision(bench: &Bench) -> Result<[f64; 2]> {
    let file = space(
        json!([
            {
                "shape": { "kind": "box", "min": [-0.4, -0.1, -0.1], "max": [-0.1, 0.1, 0.06] },
                "velocity": [1.5, 0.1, 0], "rigid": { "angular_velocity": [1, -2, 3] }
            },
            {
                "shape": { "kind": "sphere", "center": [0.1, 0.05, 0.02], "radius": 0.14 },
                "velocity": [-0.5, 0, 0.1], "rigid": { "density": 400 }, "spacing": 0.03
            },
        ]),
        0.5,
    );
    let (scene, all) = motions(bench, &file)?;
    let start = momenta(&scene, &all[0]);
    let scale: f64 = scene
        .rigid_bodies
        .iter()
        .map(|body| body.mass * body.velocity.length())
        .sum();
    let off = |which: usize, scale: f64| {
        let errors = all
            .iter()
            .map(|motions| momenta(&scene, motions)[which].distance(start[which]) / scale);
        errors.fold(0.0, f64::max)
    };
    Ok([off(0, scale), off(1, 0.3 * scale)])
}

/// Errors of angular momentum and energy.
fn tumbling(bench: &Bench) -> Result<[f64; 2]> {
    let file = space(
        json!([{
            "shape": { "kind": "box", "min": [-0.2, -0.1, -0.05], "max": [0.2, 0.1, 0.05] },
            "rigid": { "angular_velocity": [0.02, 9, 0.01] }
        }]),
        2.0,
    );
    let (scene, all) = motions(bench, &file)?;
    let start = momenta(&scene, &all[0])[1];
    let energy = |motions: &[BodyMotion]| energies(&scene, Default::default(), motions)[0];
    let mut errors = [0.0f64; 2];
    for motions in &all {
        let angular = momenta(&scene, motions)[1].distance(start) / start.length();
        errors[0] = errors[0].max(angular);
        errors[1] = errors[1].max((energy(motions) / energy(&all[0]) - 1.0).abs());
    }
    Ok(errors)
}

/// Acceleration of a covered ball down a slope over that of a smooth one; `spacing` in radii of particles.
fn rolling(bench: &Bench, spacing: f64, restitution: f64) -> Result<f64> {
    let (radius, ball, slope) = (0.02, 0.2, 20f64.to_radians());
    let file = json!({
        "name": "rolling",
        "domain": { "min": [-0.5, 0, -0.5], "max": [2.5, 1, 0.5], "walls": "open", "sides": { "y_min": "contact" } },
        "gravity": [GRAVITY * slope.sin(), -GRAVITY * slope.cos(), 0],
        "grains": {
            "radius": radius, "density": 1000, "law": "linear", "spring": 1e5, "restitution": restitution, "friction": 0.8
        },
        "bodies": [{
            "shape": { "kind": "sphere", "center": [0, ball, 0], "radius": ball }, "spacing": spacing * radius, "rigid": {}
        }],
        "time": { "duration": 0.8, "fps": 5 },
    });
    let (scene, all) = motions(bench, &file)?;
    let last = all.len() - 1;
    // By its angular momentum about the contact, 7/5 R v where it rolls: it bounces a little, and then slides to and fro.
    let speed = |frame: usize| {
        let body = all[frame][0];
        (body.velocity.x - 0.4 * ball * body.angular_velocity.z) / 1.4
    };
    let time = (last - 1) as f64 / scene.time.fps;
    Ok((speed(last) - speed(1)) / time / (5.0 / 7.0 * GRAVITY * slope.sin()))
}
