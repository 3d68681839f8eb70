//! Grains on a floor: impacts that slide, rolling, and a stack.

use glam::Vec3;
use serde_json::json;

use super::{Scale, floor, particles, placed};
use crate::error::Result;
use crate::output::plot::Plot;
use crate::study::accuracy::cases::columns::vectors;
use crate::study::accuracy::cases::dem::grains;
use crate::study::accuracy::reference::Table as Reference;
use crate::study::accuracy::run::run;
use crate::study::bench::Bench;
use crate::study::page::{Cell, Page, Table};
use crate::study::scenes;

const GRAVITY: f64 = 9.81;

/// Chung and Ooi 2011, test 4: radius, m; speed, m/s; friction; restitution.
const ALUMINA: (f64, f64, f64, f64) = (2.5e-3, 3.9, 0.092, 0.98);
/// Beyond this angle from the normal it slides to the end, degrees.
const SLIDES: f64 = 30.0;

pub fn oblique(page: &mut Page, bench: &Bench, scale: &Scale) -> Result<()> {
    bench.tell("grains: oblique impacts");
    page.heading("Oblique impacts on a rigid plane (Chung and Ooi 2011, test 4)");
    let (radius, speed, friction, restitution) = ALUMINA;
    let size = 0.01 * scale.angles.len().max(2) as f64;
    let file = floor(
        "oblique",
        size,
        0.0,
        json!({
            "radius": radius, "density": 4000, "law": "hertz", "young_modulus": 380e9, "poisson_ratio": 0.23,
            "restitution": restitution, "friction": friction
        }),
    );
    let spheres = scale.angles.iter().enumerate().map(|(i, angle)| {
        let (sin, cos) = angle.to_radians().sin_cos();
        let place = Vec3::new(
            size as f32 / 2.0,
            (1.002 * radius) as f32,
            0.005 + 0.01 * i as f32,
        );
        (place, speed as f32 * Vec3::new(sin as f32, -cos as f32, 0.0))
    });
    let empty = scenes::with_particles(&file, Default::default())?;
    let contact = empty.time.contact_duration.unwrap_or(1e-6);
    let scene = placed(&file, particles(spheres), contact / 50.0, 400, 1)?;
    let (mut after, mut spins) = (Vec::new(), Vec::new());
    run(bench, &scene, &["velocity", "angular_velocity"], |frame| {
        (after, spins) = (vectors(frame, "velocity"), vectors(frame, "angular_velocity"));
    })?;
    let mut table = Table::new([
        "angle, degrees",
        "tangential restitution",
        "closed form of it, where it slides",
        "spin, rad/s",
        "closed form of the spin, where it slides",
    ]);
    let mut found = Vec::new();
    let mut form = Vec::new();
    for (i, &angle) in scale.angles.iter().enumerate() {
        let theta = angle.to_radians();
        let tangential = after[i].x / (speed * theta.sin());
        let expected = 1.0 - friction * (1.0 + restitution) / theta.tan();
        let spin = -5.0 * friction * (1.0 + restitution) * speed * theta.cos() / (2.0 * radius);
        let slides = angle >= SLIDES;
        table.row([
            Cell::number(angle),
            Cell::number(tangential),
            Cell::maybe(slides.then_some(expected)),
            Cell::number(spins[i].z),
            Cell::maybe(slides.then_some(spin)),
        ]);
        found.push((angle, tangential));
        if slides {
            form.push((angle, expected));
        }
    }
    page.table("oblique", &table);
    let measured = Reference::shipped("chung_ooi2011_test4_tangential_restitution")?;
    let published = measured
        .column("angle_deg")?
        .iter()
        .copied()
        .zip(measured.column("e_t")?.iter().copied());
    let chart = Plot::new(
        "Tangential restitution of an alumina sphere",
        "angle from the normal, degrees",
        "tangential restitution",
    )
    .points("Chung and Ooi 2011", published)
    .series("Sliceflow", found)
    .series("closed form where it slides", form);
    page.picture(
        "grains_oblique.png",
        "Tangential velocity after over before the impact.",
        |path| chart.save(path),
    )
}

pub fn rolling(page: &mut Page, bench: &Bench, _: &Scale) -> Result<()> {
    bench.tell("grains: from sliding to rolling");
    page.heading("A sphere that slides comes to roll");
    let (radius, speed, friction) = (0.05, 1.0, 0.3);
    let file = floor(
        "rolling",
        2.0,
        GRAVITY,
        json!({
            "radius": radius, "density": 2500, "law": "linear", "contact_time": 1e-3, "restitution": 0.5,
            "friction": friction
        }),
    );
    let empty = scenes::with_particles(&file, Default::default())?;
    let spring = empty.friction().map_or(1.0, |law| law.walls.stiffness);
    let sunk = grains(&empty).mass * GRAVITY / spring;
    let rolls = 2.0 * speed / (7.0 * friction * GRAVITY);
    let step = rolls / 4000.0;
    let begin = (
        Vec3::new(0.2, (radius - sunk) as f32, 1.0),
        Vec3::X * speed as f32,
    );
    let scene = placed(&file, particles([begin]), step, 200, 30)?;
    let (mut speeds, mut spins) = (Vec::new(), Vec::new());
    run(bench, &scene, &["velocity", "angular_velocity"], |frame| {
        let time = f64::from(frame.index) * 200.0 * step / rolls;
        speeds.push((time, vectors(frame, "velocity")[0].x / speed));
        spins.push((
            time,
            -vectors(frame, "angular_velocity")[0].z * (radius - sunk) / speed,
        ));
    })?;
    let last = speeds[30].1;
    let slope = (speeds[18].1 - speeds[2].1) / (speeds[18].0 - speeds[2].0);
    let time = speeds[18].0 + (last - speeds[18].1) / slope;
    let mut table = Table::new(["what", "found over closed form, less 1"]);
    for (what, error) in [
        ("time until it rolls, 2 v₀/(7 μ g)", time - 1.0),
        ("speed then, 5 v₀/7", last * 7.0 / 5.0 - 1.0),
        ("ω R over speed", spins[30].1 / last - 1.0),
    ] {
        table.row([Cell::text(what), Cell::number(error)]);
    }
    page.table("rolling", &table);
    let chart = Plot::new(
        "From sliding to rolling",
        "time over 2 v₀/(7 μ g)",
        "over the speed at the start",
    )
    .series("speed", speeds)
    .series("ω R", spins)
    .mark_y(5.0 / 7.0, "5/7");
    page.picture("grains_rolling.png", "Speed, and that of the surface.", |path| {
        chart.save(path)
    })
}

pub fn stack(page: &mut Page, bench: &Bench, scale: &Scale) -> Result<()> {
    bench.tell("grains: a stack of ten");
    page.heading("A stack of ten at rest");
    let (radius, spring, n) = (0.01, 2000.0, 10u32);
    let file = floor(
        "stack",
        0.3,
        GRAVITY,
        json!({ "radius": radius, "law": "linear", "spring": spring, "restitution": 0.3 }),
    );
    let empty = scenes::with_particles(&file, Default::default())?;
    let weight = grains(&empty).mass * GRAVITY;
    let contact = empty.time.contact_duration.unwrap_or(1e-3);
    let mut top = -radius;
    let column: Vec<_> = (0..n)
        .map(|i| {
            top += 2.0 * radius - f64::from(n - i) * weight / spring;
            (Vec3::new(0.15, top as f32, 0.15), Vec3::ZERO)
        })
        .collect();
    let frames = 4;
    let scene = placed(
        &file,
        particles(column),
        contact / 40.0,
        scale.rest / frames,
        frames,
    )?;
    let mut heights: Vec<Vec<f64>> = Vec::new();
    run(bench, &scene, &["position"], |frame| {
        heights.push(vectors(frame, "position").iter().map(|p| p.y).collect());
    })?;
    let (then, now) = (&heights[1], &heights[frames as usize]);
    let mut table = Table::new([
        "contact, from below",
        "overlap over (N − i + 1) m g/k, less 1",
        "moved in the last three quarters, diameters",
    ]);
    let mut below = -radius;
    for i in 0..n as usize {
        let overlap = 2.0 * radius - (now[i] - below);
        let expected = (n as usize - i) as f64 * weight / spring;
        table.row([
            Cell::count(i as u64 + 1),
            Cell::number(overlap / expected - 1.0),
            Cell::number((now[i] - then[i]) / (2.0 * radius)),
        ]);
        below = now[i];
    }
    page.table("stack", &table);
    page.paragraph(format!("After {} steps.", scale.rest));
    Ok(())
}
