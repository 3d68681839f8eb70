//! Heaps: their angle against friction.

use serde_json::json;

use super::Scale;
use crate::error::Result;
use crate::output::plot::Plot;
use crate::scene::Scene;
use crate::scene::model::View;
use crate::study::accuracy::cases::columns::vectors;
use crate::study::accuracy::run::run;
use crate::study::bench::Bench;
use crate::study::page::{Cell, Page, Table};
use crate::study::scenes;

const RADIUS: f64 = 0.01;
/// Over the greatest part of the slope; feet and tops are rounder.
const SLOPE: [f64; 2] = [0.2, 0.8];
const GRAVITY: f64 = 9.81;

pub fn heap(page: &mut Page, bench: &Bench, scale: &Scale) -> Result<()> {
    page.heading("The angle of a heap against friction");
    let mut table = Table::new([
        "friction",
        "seed",
        "discs",
        "angle, degrees",
        "height over half the width, degrees",
        "fastest grain at the end, √(g d)",
    ]);
    let mut means = Vec::new();
    for &friction in scale.friction {
        let mut angles = Vec::new();
        for seed in 0..scale.seeds {
            bench.tell(&format!("grains: heap with friction {friction}, seed {seed}"));
            let scene = poured(friction, seed, scale.discs)?;
            let (mut position, mut velocity) = (Vec::new(), Vec::new());
            run(bench, &scene, &["position", "velocity"], |frame| {
                (position, velocity) = (vectors(frame, "position"), vectors(frame, "velocity"));
            })?;
            let fastest = velocity.iter().map(|v| v.length()).fold(0.0, f64::max);
            let tops: Vec<[f64; 2]> = position.iter().map(|p| [p.x, p.y]).collect();
            let (angle, whole) = angles_of(&tops);
            table.row([
                Cell::number(friction),
                Cell::count(seed),
                Cell::count(position.len() as u64),
                Cell::number(angle),
                Cell::number(whole),
                Cell::number(fastest / (GRAVITY * 2.0 * RADIUS).sqrt()),
            ]);
            angles.push(angle);
        }
        means.push((friction, angles.iter().sum::<f64>() / angles.len() as f64));
    }
    page.table("heap", &table);
    let chart = Plot::new(
        "Angle of a heap of discs",
        "coefficient of friction",
        "angle, degrees",
    )
    .series("mean over seeds", means)
    .from_lowest();
    page.picture(
        "grains_heap_angle.png",
        "Angle of the slopes against friction.",
        |path| chart.save(path),
    )?;
    let scene = poured(scale.friction[scale.friction.len() - 1], 0, scale.discs)?;
    if let Some(picture) = bench.picture(&scene, View::Scene, scene.time.frames - 1)? {
        page.picture(
            "grains_heap.png",
            "The heap with the greatest friction.",
            |path| crate::output::write_file(path, &crate::output::encode_png(picture, path)?),
        )?;
    }
    page.paragraph(
        "Discs pour in disorder onto a floor that holds them by the same friction; the resistance to rolling is half of it. \
         The angle is that of a line through the highest discs of each slope, from a fifth to four fifths of the height.",
    );
    Ok(())
}

/// A heap that has come to rest.
fn poured(friction: f64, seed: u64, discs: u32) -> Result<Scene> {
    let width = 2.0 * RADIUS * 2.2 * f64::from(discs).sqrt();
    let height = 1.2 * RADIUS * f64::from(discs).sqrt() + 0.2;
    // So that they come within a second and a half.
    let half = (f64::from(discs) / 1.5 / 0.8 * (2.2 * RADIUS).powi(2) / 2.0).max(3.0 * RADIUS);
    let flows = f64::from(discs) * (2.2 * RADIUS).powi(2) / (2.0 * half);
    scenes::parse(&json!({
        "name": format!("heap, friction {friction}"),
        "dimensions": 2,
        "seed": seed,
        "domain": {
            "min": [-width, 0], "max": [width, height], "walls": "open", "sides": { "y_min": "contact" }
        },
        "gravity": [0, -GRAVITY],
        "grains": {
            "radius": RADIUS, "density": 1600, "law": "linear", "spring": 2e5, "restitution": 0.3,
            "friction": friction, "rolling_friction": friction / 2.0
        },
        "emitters": [{ "name": "spout", "center": [0, height - 2.0 * RADIUS], "radius": half, "velocity": [0, -1] }],
        "events": [{ "at": flows, "emitter": { "name": "spout", "on": false } }],
        "time": { "duration": flows + 2.0, "fps": 10, "steps_per_contact": 25 },
        "render": { "splat": "disc", "size": [960, 360], "color": { "by": "id", "map": "turbo" } }
    }))
}

/// Of the slopes, and of height over half the width, degrees.
fn angles_of(discs: &[[f64; 2]]) -> (f64, f64) {
    let highest = discs.iter().fold(0.0f64, |y, p| y.max(p[1]));
    let middle = discs.iter().map(|p| p[0]).sum::<f64>() / discs.len().max(1) as f64;
    let mut slopes = Vec::new();
    for side in [-1.0, 1.0] {
        // The highest disc of each strip as wide as a disc, by distance from the middle.
        let mut surface: Vec<f64> = Vec::new();
        for p in discs {
            let away = side * (p[0] - middle);
            if away < 0.0 {
                continue;
            }
            let strip = (away / (2.0 * RADIUS)) as usize;
            if strip >= surface.len() {
                surface.resize(strip + 1, 0.0);
            }
            surface[strip] = surface[strip].max(p[1]);
        }
        let inside: Vec<(f64, f64)> = surface
            .iter()
            .enumerate()
            .map(|(strip, &y)| ((strip as f64 + 0.5) * 2.0 * RADIUS, y))
            .filter(|(_, y)| (SLOPE[0] * highest..=SLOPE[1] * highest).contains(y))
            .collect();
        if inside.len() > 1 {
            slopes.push(-slope(&inside));
        }
    }
    let angle = slopes.iter().sum::<f64>() / slopes.len().max(1) as f64;
    // Single discs that rolled away are not the heap.
    let mut away: Vec<f64> = discs.iter().map(|p| (p[0] - middle).abs()).collect();
    away.sort_by(f64::total_cmp);
    let half = away.get(away.len() * 95 / 100).copied().unwrap_or(1.0);
    (angle.atan().to_degrees(), (highest / half).atan().to_degrees())
}

/// Of the line of least squares.
fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let x = points.iter().map(|p| p.0).sum::<f64>() / n;
    let y = points.iter().map(|p| p.1).sum::<f64>() / n;
    let up: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    let across: f64 = points.iter().map(|p| (p.0 - x).powi(2)).sum();
    up / across
}

#[cfg(test)]
mod tests {
    use super::{RADIUS, angles_of};

    #[test]
    fn a_triangle_has_its_angle() {
        let mut discs = Vec::new();
        for row in 0..20 {
            for i in -40 + 2 * row..=40 - 2 * row {
                discs.push([
                    f64::from(i) * 2.0 * RADIUS,
                    f64::from(row) * 2.0 * RADIUS + RADIUS,
                ]);
            }
        }
        // A row is a diameter high, and a slope steps in by two of them.
        let (angle, _) = angles_of(&discs);
        assert!((angle - 0.5f64.atan().to_degrees()).abs() < 1.5, "{angle}");
    }
}
