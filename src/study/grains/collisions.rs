//! Head-on collisions.

use glam::Vec3;
use serde_json::json;

use super::{Scale, empty, particles, placed};
use crate::error::Result;
use crate::output::plot::Plot;
use crate::study::accuracy::cases::columns::vectors;
use crate::study::accuracy::published;
use crate::study::accuracy::run::run;
use crate::study::bench::Bench;
use crate::study::page::{Cell, Page, Table};

const RADIUS: f64 = 0.01;
/// Of each grain, m/s.
const SPEED: f64 = 0.5;
const RESTITUTIONS: [f64; 5] = [0.3, 0.5, 0.7, 0.9, 1.0];
const PAIRS: u32 = 16;
/// A contact lasts so many steps more than a whole number of them, so that it ends somewhere in a step.
const ODD: f64 = 0.3;

pub fn restitution(page: &mut Page, bench: &Bench, scale: &Scale) -> Result<()> {
    page.heading("Restitution of linear springs and dashpots");
    let mut table = Table::new(["steps per contact", "e", "largest error of e"]);
    let mut worst = Vec::new();
    for &steps in scale.steps {
        bench.tell(&format!("grains: restitution at {steps} steps per contact"));
        let mut all = 0.0f64;
        for restitution in RESTITUTIONS {
            let error = error_of(bench, restitution, steps)?;
            table.row([
                Cell::count(steps.into()),
                Cell::number(restitution),
                Cell::number(error),
            ]);
            all = all.max(error);
        }
        worst.push((f64::from(steps), all));
    }
    page.table("restitution", &table);
    let mut chart = Plot::new("Error of restitution", "steps per contact", "largest error of e")
        .log_x()
        .log_y()
        .series("Sliceflow, e from 0.3 to 1", worst);
    let known: Vec<_> = scale
        .steps
        .iter()
        .filter_map(|&steps| Some((f64::from(steps), published::COLLISION[0].error_at(steps)?)))
        .collect();
    if !known.is_empty() {
        chart = chart.points(published::COLLISION[0].method, known);
    }
    let chart = chart.mark_y(1e-3, "bar at 50 steps");
    page.picture(
        "grains_restitution.png",
        "Largest error of the restitution over all pairs.",
        |path| chart.save(path),
    )?;
    page.paragraph(format!(
        "{PAIRS} pairs meet head-on at different parts of a step, and part at others, since a contact lasts {ODD} steps more \
         than the number that is given. A dashpot acts for the share of a step in which grains overlap; the error then falls \
         with the square of the step."
    ));
    Ok(())
}

/// The largest difference of any pair.
fn error_of(bench: &Bench, restitution: f64, steps: u32) -> Result<f64> {
    let duration = 1e-3;
    let step = duration / (f64::from(steps) + ODD);
    let file = empty(
        "collision",
        1.0,
        json!({ "radius": RADIUS, "law": "linear", "contact_time": duration, "restitution": restitution }),
    );
    let pairs = (0..PAIRS).flat_map(|pair| {
        let gap = 2.0 * SPEED * step * (1.0 + f64::from(pair) / f64::from(PAIRS));
        let center = Vec3::new(0.5, 0.2 + 0.2 * (pair % 4) as f32, 0.2 + 0.2 * (pair / 4) as f32);
        let half = Vec3::X * (RADIUS + gap / 2.0) as f32;
        let velocity = Vec3::X * SPEED as f32;
        [(center - half, velocity), (center + half, -velocity)]
    });
    let scene = placed(&file, particles(pairs), step, steps + steps / 2, 1)?;
    let mut after = Vec::new();
    run(bench, &scene, &["velocity"], |frame| {
        after = vectors(frame, "velocity")
    })?;
    let found = after
        .chunks_exact(2)
        .map(|pair| (pair[1].x - pair[0].x) / (2.0 * SPEED));
    Ok(found.map(|e| (e - restitution).abs()).fold(0.0, f64::max))
}

/// The two glass spheres of Chung and Ooi 2011, test 1.
const GLASS: (f64, f64) = (0.01, 10.0);
/// Closed form: greatest overlap, m, and duration, s (`dem_hertz_closed_form`).
const IMPACT: (f64, f64) = (0.000_274_112_7, 4.033_945e-5);

pub fn hertz(page: &mut Page, bench: &Bench, scale: &Scale) -> Result<()> {
    page.heading("An elastic impact (Hertz 1882; Chung and Ooi 2011, test 1)");
    let (radius, speed) = GLASS;
    let (deepest, duration) = IMPACT;
    let file = empty(
        "hertz",
        0.1,
        json!({
            "radius": radius, "density": 2800, "law": "hertz", "young_modulus": 48e9, "poisson_ratio": 0.2,
            "restitution": 1, "friction": 0
        }),
    );
    let mut table = Table::new([
        "steps per contact",
        "error of the greatest overlap",
        "error of the duration",
        "error of e",
    ]);
    for &steps in scale.steps {
        bench.tell(&format!("grains: Hertz at {steps} steps per contact"));
        let step = duration / (f64::from(steps) + ODD);
        let gap = 2.0 * speed * step * 1.4;
        let center = Vec3::splat(0.05);
        let half = Vec3::X * (radius + gap / 2.0) as f32;
        let velocity = Vec3::X * speed as f32;
        let pair = particles([(center - half, velocity), (center + half, -velocity)]);
        let last = steps + steps / 4;
        let scene = placed(&file, pair, step, 1, last)?;
        let (mut overlap, mut apart, mut back) = (0.0f64, 0.0, 0.0);
        run(bench, &scene, &["position", "velocity"], |frame| {
            let (x, v) = (vectors(frame, "position"), vectors(frame, "velocity"));
            apart = x[1].x - x[0].x - 2.0 * radius;
            back = v[1].x - v[0].x;
            overlap = overlap.max(-apart);
        })?;
        let found = f64::from(last) * step - gap / (2.0 * speed) - apart / back;
        table.row([
            Cell::count(steps.into()),
            Cell::number(overlap / deepest - 1.0),
            Cell::number(found / duration - 1.0),
            Cell::number(back / (2.0 * speed) - 1.0),
        ]);
    }
    page.table("hertz", &table);
    page.paragraph(
        "The greatest overlap is that at the end of a step, so it is too small by up to (π/2n)²/2 with n steps in a contact.",
    );
    Ok(())
}
