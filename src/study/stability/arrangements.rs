//! Hard cases by how particles lie and where: pairs that nearly coincide, lines, bodies in one another, tall columns, wide and far
//! domains.

use glam::Vec3;
use serde_json::{Value, json};

use super::hard::{Case, Tried, kept, part};
use super::methods::{EXPECTED, SPACING, block};
use super::trial::{Outcome, Trouble, lost, run};
use crate::error::Result;
use crate::scene::Scene;
use crate::study::bench::Bench;
use crate::study::page::shown;

/// Distance of a pair, in spacings.
const NEARLY: f64 = 1e-7;
/// Of the bullet, in expected speeds.
const BULLET: f64 = 50.0;
/// Metres from zero.
const FAR: f64 = 1e6;
/// Voxels side by side: a domain as wide as this many search radii.
const WIDE: f64 = 10_000.0;

pub const ARRANGEMENTS: [(&str, Case); 9] = [
    ("a pair 1e-7 spacings apart", pair),
    ("a line that falls flat", line),
    ("a line that stands", standing_line),
    ("two blocks in one another", overlapping),
    ("a bullet into a pile", bullet),
    ("a column 20 times as high as wide", column),
    ("a block that drifts without weight", drift),
    ("a domain 10,000 voxels wide", wide),
    ("the same 1,000 km away", far),
];

/// What must hold, for the page.
pub fn about() -> String {
    format!(
        "*Pair*: as coincident, but {} spacings apart. *Lines*: one row of 20 particles falls flat on the floor, or stands on \
         it; no particle is lost and energy does not grow, as for an impact. *Blocks in one another*: two blocks of 8 × 8, half a \
         spacing aside; they come apart, and nothing is lost or becomes no number. *Bullet*: a particle hits a pile of 16 × 8 at {} times the \
         expected speed. *Column*: 2 × 40 particles collapse. *Drift*: a block without weight moves at the expected speed, and its \
         center of mass is where it should be to {} of its way. *Wide*: a block falls at the end of a domain as wide as {} \
         search radii. *Far*: a block that falls {} m from zero has the same velocities as near it, to the bit.",
        shown(NEARLY),
        shown(BULLET),
        shown(DRIFT),
        shown(WIDE),
        shown(FAR),
    )
}

/// Largest error of a drift, as a share of its way.
const DRIFT: f64 = 1e-3;

fn pair(bench: &Bench, tried: Tried, steps: u32) -> Result<Outcome> {
    let scene = tried
        .method
        .scene(block([0.4, 0.0], 8, 8), |file| tried.expect(file))?;
    part(bench, scene, [27, 28], Vec3::X * (NEARLY * SPACING) as f32, steps)
}

fn line(bench: &Bench, tried: Tried, steps: u32) -> Result<Outcome> {
    let scene = tried
        .method
        .scene(block([0.2, 2.0 * SPACING], 20, 1), |file| tried.expect(file))?;
    kept(bench, &scene, steps)
}

fn standing_line(bench: &Bench, tried: Tried, steps: u32) -> Result<Outcome> {
    let scene = tried
        .method
        .scene(block([0.5, 0.0], 1, 20), |file| tried.expect(file))?;
    kept(bench, &scene, steps)
}

fn overlapping(bench: &Bench, tried: Tried, steps: u32) -> Result<Outcome> {
    let mut scene = tried.method.scene(block([0.4, 0.4], 8, 16), |file| {
        tried.expect(file);
        file["gravity"] = json!([0, 0]);
    })?;
    // The upper half comes down into the lower one.
    let half = scene.particles.len() / 2;
    let aside = Vec3::new(0.5, 0.5, 0.0) * SPACING as f32;
    for slot in half..scene.particles.len() {
        scene.particles.position[slot] = scene.particles.position[slot - half] + aside;
    }
    Ok(
        run(bench, &scene, steps, 1)?.and_then(|trial| match lost(&scene, &trial.last) {
            0 => Ok(()),
            lost => Err(Trouble::Wrong(format!("{lost} particles are lost"))),
        }),
    )
}

fn bullet(bench: &Bench, tried: Tried, steps: u32) -> Result<Outcome> {
    let mut shot = block([0.5, 0.3], 1, 1);
    shot["velocity"] = json!([0, -BULLET * EXPECTED]);
    let scene = tried.method.scene(block([0.3, 0.0], 16, 8), |file| {
        tried.expect(file);
        file["bodies"].as_array_mut().expect("bodies").push(shot);
    })?;
    kept(bench, &scene, steps)
}

fn column(bench: &Bench, tried: Tried, steps: u32) -> Result<Outcome> {
    let scene = tried.method.scene(block([0.5, 0.0], 2, 40), |file| {
        tried.expect(file);
        file["domain"]["max"] = json!([1, 1.5]);
    })?;
    kept(bench, &scene, steps)
}

fn drift(bench: &Bench, tried: Tried, steps: u32) -> Result<Outcome> {
    let mut body = block([0.4, 0.4], 8, 8);
    body["velocity"] = json!([EXPECTED, 0]);
    let scene = tried.method.scene(body, |file| {
        tried.expect(file);
        file["gravity"] = json!([0, 0]);
        file["domain"]["walls"] = "open".into();
    })?;
    Ok(run(bench, &scene, steps, 1)?.and_then(|trial| {
        let time = trial.moments.last().map_or(f64::NAN, |moment| moment.time);
        let way = center(&trial.last.position) - center(&scene.particles.position);
        let off = (way - glam::DVec3::X * EXPECTED * time).length() / (EXPECTED * time);
        match off < DRIFT {
            true => Ok(()),
            false => Err(Trouble::Wrong(format!(
                "its center is off by {} of its way",
                shown(off)
            ))),
        }
    }))
}

fn center(positions: &[Vec3]) -> glam::DVec3 {
    let sum: glam::DVec3 = positions.iter().map(|position| position.as_dvec3()).sum();
    sum / positions.len() as f64
}

fn wide(bench: &Bench, tried: Tried, steps: u32) -> Result<Outcome> {
    let near = tried
        .method
        .scene(block([0.0, 0.1], 8, 8), |file| tried.expect(file))?;
    let width = (WIDE * near.search_radius() / SPACING).round() * SPACING;
    let scene = tried.method.scene(block([0.0, 0.1], 8, 8), |file| {
        tried.expect(file);
        file["domain"]["max"] = json!([width, 1]);
    })?;
    kept(bench, &scene, steps)
}

fn far(bench: &Bench, tried: Tried, steps: u32) -> Result<Outcome> {
    let moved = |by: f64| -> Result<Scene> {
        tried.method.scene(block([0.4, 0.1], 8, 8), |file| {
            tried.expect(file);
            for key in [
                "/domain/min/0",
                "/domain/max/0",
                "/bodies/0/shape/min/0",
                "/bodies/0/shape/max/0",
            ] {
                let number = file.pointer_mut(key).expect("a coordinate");
                *number = Value::from(number.as_f64().expect("a number") + by);
            }
        })
    };
    let [near, far] = [moved(0.0)?, moved(FAR)?];
    // Coordinates far away have fewer digits behind the point: so have the particles at the start, which lie as near zero.
    let far = Scene {
        particles: near.particles.clone(),
        boundary: near.boundary.clone(),
        ..far
    };
    let [near, far] = [run(bench, &near, steps, 1)?, run(bench, &far, steps, 1)?];
    Ok(near.and_then(|near| {
        let far = far?;
        let places = near.last.position.iter().zip(&far.last.position);
        // Files hold sums of f64, which round a little more far away.
        let moved = places.map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
        match moved < 1e-8 && near.last.velocity == far.last.velocity {
            true => Ok(()),
            false => Err(Trouble::Wrong(format!(
                "it moves otherwise, by {} m",
                shown(moved.into())
            ))),
        }
    }))
}
