//! Columns of discs that collapse along a wall.

use serde_json::json;

use super::Scale;
use crate::error::Result;
use crate::output::plot::Plot;
use crate::scene::Scene;
use crate::study::accuracy::cases::columns::vectors;
use crate::study::accuracy::reference::Table as Reference;
use crate::study::accuracy::run::run;
use crate::study::bench::Bench;
use crate::study::page::{Cell, Page, Table};
use crate::study::scenes;

const RADIUS: f64 = 0.005;
/// Share of a column's area that its discs fill when it stands.
const FILLED: f64 = 0.82;
/// Farther than this from the next one, in diameters, discs have left the deposit.
const GAP: f64 = 1.5;
const GRAVITY: f64 = 9.81;

pub fn collapse(page: &mut Page, bench: &Bench, scale: &Scale) -> Result<()> {
    page.heading("Columns that collapse along a wall");
    let scaling = Reference::shipped("column_collapse_scaling_2d")?;
    let column = |name: &str| scaling.column(name).map(<[f64]>::to_vec);
    let (low, high, power, change) = (
        column("lambda1")?,
        column("lambda2")?,
        column("power")?,
        column("a0")?,
    );
    let published = |row: usize, aspect: f64| match aspect < change[row] {
        true => low[row] * aspect,
        false => high[row] * aspect.powf(power[row]),
    };
    let mut table = Table::new([
        "height over width",
        "discs",
        "runout over width",
        "Lube 2005",
        "Lajeunesse 2005",
    ]);
    let mut found = Vec::new();
    for &aspect in scale.aspects {
        bench.tell(&format!("grains: a column {aspect} times as high as wide"));
        let (scene, width) = column_of(aspect, scale.discs)?;
        let mut position = Vec::new();
        run(bench, &scene, &["position"], |frame| {
            position = vectors(frame, "position")
        })?;
        let height = position.len() as f64 * std::f64::consts::PI * RADIUS * RADIUS / (FILLED * width);
        let aspect = height / width;
        let runout = (deposit_end(position.iter().map(|p| p.x).collect()) - width) / width;
        table.row([
            Cell::number(aspect),
            Cell::count(position.len() as u64),
            Cell::number(runout),
            Cell::number(published(0, aspect)),
            Cell::number(published(1, aspect)),
        ]);
        found.push((aspect, runout));
    }
    page.table("collapse", &table);
    let line = |row: usize| {
        found
            .iter()
            .map(move |&(aspect, _)| (aspect, published(row, aspect)))
    };
    let chart = Plot::new(
        "Runout of columns of discs",
        "height over width at the start",
        "runout over width at the start",
    )
    .log_x()
    .log_y()
    .series("Lube 2005, measured", line(0))
    .series("Lajeunesse 2005, measured", line(1))
    .points("Sliceflow", found.iter().copied());
    page.picture(
        "grains_collapse.png",
        "Runout against the aspect ratio.",
        |path| chart.save(path),
    )?;
    page.paragraph(format!(
        "Friction 0.5, rolling friction 0.1. The height is that of so many discs if they filled {FILLED} of the column; the \
         deposit ends where the next disc is more than {GAP} diameters away."
    ));
    Ok(())
}

/// The scene, and the width of its column, m.
fn column_of(aspect: f64, discs: u32) -> Result<(Scene, f64)> {
    let area = f64::from(discs) * std::f64::consts::PI * RADIUS * RADIUS / FILLED;
    // Whole discs beside each other.
    let spacing = 2.1 * RADIUS;
    let across = ((area / aspect).sqrt() / spacing).round().max(2.0);
    let layers = (f64::from(discs) / across).round().max(1.0);
    let (width, height) = (across * spacing, layers * spacing);
    let reach = width * (2.0 + 4.0 * aspect.max(1.0));
    let fall = (2.0 * height / GRAVITY).sqrt();
    let scene = scenes::parse(&json!({
        "name": format!("a column {aspect} times as high as wide"),
        "dimensions": 2,
        "domain": {
            "min": [0, 0], "max": [reach, 1.1 * height], "walls": "open",
            "sides": { "x_min": "contact", "y_min": "contact" }
        },
        "gravity": [0, -GRAVITY],
        "grains": {
            "radius": RADIUS, "density": 2500, "law": "linear", "spring": 1e5, "restitution": 0.5,
            "friction": 0.5, "wall_friction": 0.5, "rolling_friction": 0.1
        },
        "bodies": [{
            "shape": { "kind": "box", "min": [0, 0], "max": [width, height] }, "spacing": spacing, "jitter": 0.02
        }],
        "time": { "duration": 8.0 * fall, "fps": 4.0 / (8.0 * fall), "steps_per_contact": 25 }
    }))?;
    Ok((scene, width))
}

/// Where discs that stand one behind the other from x = 0 end.
fn deposit_end(mut x: Vec<f64>) -> f64 {
    x.sort_by(f64::total_cmp);
    let mut end = 0.0;
    for x in x {
        if x - end > GAP * 2.0 * RADIUS {
            break;
        }
        end = x;
    }
    end + RADIUS
}
