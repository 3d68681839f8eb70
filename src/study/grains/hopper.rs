//! Bins that empty through an opening in their floor.

use glam::DVec3;
use serde_json::{Value, json};

use super::{Scale, particles};
use crate::error::Result;
use crate::output::plot::Plot;
use crate::scene::Scene;
use crate::scene::model::View;
use crate::study::accuracy::cases::columns::vectors;
use crate::study::accuracy::run::run;
use crate::study::bench::Bench;
use crate::study::page::{Cell, Page, Table};
use crate::study::scenes;

/// A bin with a flat floor; lengths in diameters.
pub struct Bin {
    /// 2, or 3 with a square floor and a square opening.
    pub dimensions: usize,
    /// Across, and of the filling before it settles.
    pub width: u32,
    pub height: u32,
    /// Widths of the openings.
    pub openings: &'static [f64],
    /// Grains that flow out before the run ends, about.
    pub grains: f64,
}

const RADIUS: f64 = 0.005;
const DIAMETER: f64 = 2.0 * RADIUS;
const GRAVITY: f64 = 9.81;
/// Diameters that an opening seems to be narrower (Beverloo 1961).
const NARROWER: f64 = 1.4;
/// Until grains flow steadily, √(d/g).
const BEGINS: f64 = 5.0;
/// Until a filling is at rest, √(d/g).
const SETTLES: f64 = 20.0;
/// Of the floor, in diameters.
const THICKNESS: f64 = 2.0;
/// Of discs and of spheres: N/m, so that the lowest layer is pressed in by a few percent.
const SPRING: [f64; 2] = [2e5, 1500.0];

pub fn hopper(page: &mut Page, bench: &Bench, scale: &Scale) -> Result<()> {
    page.heading("Flow out of a bin (Beverloo 1961)");
    let mut rates = Table::new([
        "dimensions",
        "opening, diameters",
        "grains in the bin",
        "flow, grains per √(d/g)",
        "Beverloo's law with one factor for all",
    ]);
    let mut fits = Table::new(["dimensions", "exponent", "Beverloo", "error", "R²"]);
    let mut chart = Plot::new(
        "Flow out of a bin",
        "opening less 1.4 diameters, diameters",
        "grains in the time sqrt(d/g)",
    )
    .log_x()
    .log_y();
    let mut shown = None;
    for bin in scale.bins {
        let what = format!("{}D", bin.dimensions);
        bench.tell(&format!("grains: a bin in {what} is filled"));
        let filled = settled(bench, bin)?;
        let mut found = Vec::new();
        for &opening in bin.openings {
            bench.tell(&format!(
                "grains: a bin in {what} with an opening of {opening} diameters"
            ));
            let scene = opened(bin, opening, &filled)?;
            found.push((opening, flow(bench, &scene)?));
            shown = shown.or((bin.dimensions == 2).then_some(scene));
        }
        let exponent = bin.dimensions as f64 - 0.5;
        let points: Vec<_> = found
            .iter()
            .map(|&(opening, flow)| (opening - NARROWER, flow))
            .collect();
        let logs = points.iter().map(|(x, y)| (x.ln(), y.ln()));
        let fit = Line::through(&logs.collect::<Vec<_>>());
        let factor = points
            .iter()
            .map(|(x, y)| (y / x.powf(exponent)).ln())
            .sum::<f64>()
            / points.len() as f64;
        let law = |x: f64| factor.exp() * x.powf(exponent);
        for (&(opening, flow), &(x, _)) in found.iter().zip(&points) {
            rates.row([
                Cell::count(bin.dimensions as u64),
                Cell::number(opening),
                Cell::count(filled.len() as u64),
                Cell::number(flow),
                Cell::number(law(x)),
            ]);
        }
        fits.row([
            Cell::count(bin.dimensions as u64),
            Cell::number(fit.slope),
            Cell::number(exponent),
            Cell::number(fit.slope - exponent),
            Cell::number(fit.explained),
        ]);
        let line: Vec<_> = points.iter().map(|&(x, _)| (x, law(x))).collect();
        chart = chart
            .points(format!("Sliceflow, {what}"), points)
            .series(format!("Beverloo, exponent {exponent}"), line);
    }
    page.table("hopper", &rates);
    page.table("hopper_exponent", &fits);
    page.picture("grains_hopper.png", "Flow against the opening.", |path| {
        chart.save(path)
    })?;
    if let Some(scene) = shown
        && let Some(picture) = bench.picture(&scene, View::Scene, scene.time.frames / 2)?
    {
        page.picture("grains_hopper_flow.png", "A bin that empties.", |path| {
            crate::output::write_file(path, &crate::output::encode_png(picture, path)?)
        })?;
    }
    page.paragraph(format!(
        "Bins with a flat floor, friction 0.3; the opening is a slit in 2D, and a square in 3D. The flow \
         is the slope of the number of grains below the floor against time, from {BEGINS} √(d/g) after the opening on. The \
         exponent is the slope of its logarithm against that of the opening less {NARROWER} diameters, where grains cannot \
         pass (Beverloo's k)."
    ));
    Ok(())
}

/// What is common to a bin that is filled and one that empties.
fn file_of(bin: &Bin, name: &str, min: [f64; 3], max: [f64; 3]) -> Value {
    let axes = bin.dimensions;
    let mut gravity = [0.0; 3];
    gravity[1] = -GRAVITY;
    json!({
        "name": name,
        "dimensions": axes,
        "domain": { "min": min[..axes], "max": max[..axes] },
        "gravity": gravity[..axes],
        "grains": {
            "radius": RADIUS, "density": 2500, "law": "linear", "spring": SPRING[axes - 2], "restitution": 0.5,
            "friction": 0.3
        },
        "render": { "splat": "disc", "size": [640, 720], "color": { "by": "speed", "map": "viridis", "range": [0, 0.5] } },
        "time": { "steps_per_contact": 20 },
    })
}

fn metres(diameters: f64) -> f64 {
    DIAMETER * diameters
}

/// √(d/g), s.
fn unit() -> f64 {
    (DIAMETER / GRAVITY).sqrt()
}

/// Grains at rest in a closed bin, from below to above.
fn settled(bench: &Bench, bin: &Bin) -> Result<Vec<DVec3>> {
    let (width, height) = (metres(bin.width.into()), metres(bin.height.into()));
    let max = [width, 1.2 * height, width];
    let mut file = file_of(bin, "a bin that is filled", [0.0; 3], max);
    let mut top = max;
    top[1] = height;
    file["bodies"] = json!([{
        "shape": { "kind": "box", "min": vec![0.0; bin.dimensions], "max": top[..bin.dimensions] },
        "spacing": 1.1 * DIAMETER, "jitter": 0.05
    }]);
    let seconds = SETTLES * unit();
    file["time"]["duration"] = seconds.into();
    file["time"]["fps"] = (2.0 / seconds).into();
    let mut position = Vec::new();
    run(bench, &scenes::parse(&file)?, &["position"], |frame| {
        position = vectors(frame, "position")
    })?;
    position.sort_by(|a, b| a.y.total_cmp(&b.y));
    Ok(position)
}

/// The same above a floor with an opening, as long as it takes them to flow out.
fn opened(bin: &Bin, opening: f64, filled: &[DVec3]) -> Result<Scene> {
    let (width, height) = (metres(bin.width.into()), metres(bin.height.into()));
    let below = metres(THICKNESS + 4.0);
    let mut file = file_of(
        bin,
        "a bin that empties",
        [0.0, -below, 0.0],
        [width, 1.2 * height, width],
    );
    file["domain"]["sides"] = json!({ "y_min": "open" });
    // Of the hole, and of the floor around it.
    let hole = [0.5, -0.5].map(|share| (width - share * 2.0 * metres(opening)) / 2.0);
    let [low, high] = [-metres(1.0), width + metres(1.0)];
    let part = |x: [f64; 2], z: [f64; 2]| {
        let corner = |end: usize, y: f64| [x[end], y, z[end]][..bin.dimensions].to_vec();
        json!({ "shape": { "kind": "box", "min": corner(0, -metres(THICKNESS)), "max": corner(1, 0.0) } })
    };
    let mut floor = vec![
        part([low, hole[0]], [low, high]),
        part([hole[1], high], [low, high]),
    ];
    if bin.dimensions == 3 {
        floor.push(part(hole, [low, hole[0]]));
        floor.push(part(hole, [hole[1], high]));
    }
    file["colliders"] = floor.into();
    let seconds = unit() * (BEGINS + bin.grains / expected(bin.dimensions, opening));
    file["time"]["duration"] = seconds.into();
    file["time"]["fps"] = (FRAMES / seconds).into();
    let places = filled.iter().map(|p| (p.as_vec3(), glam::Vec3::ZERO));
    scenes::with_particles(&file, particles(places))
}

const FRAMES: f64 = 60.0;

/// Grains per √(d/g) as others found them, which says how long a run has to be.
fn expected(dimensions: usize, opening: f64) -> f64 {
    0.85 * (opening - NARROWER).powf(dimensions as f64 - 0.5)
}

/// Grains that flow out in √(d/g) while the flow is steady.
fn flow(bench: &Bench, scene: &Scene) -> Result<f64> {
    let mut out = Vec::new();
    let all = scene.particles.len();
    run(bench, scene, &["position"], |frame| {
        let above = vectors(frame, "position").iter().filter(|p| p.y > 0.0).count();
        let time = frame.time / unit();
        if time >= BEGINS {
            out.push((time, (all - above) as f64));
        }
    })?;
    Ok(Line::through(&out).slope)
}

/// A line of least squares.
struct Line {
    slope: f64,
    /// R²: the share of the variance that it explains.
    explained: f64,
}

impl Line {
    fn through(points: &[(f64, f64)]) -> Self {
        let n = points.len().max(1) as f64;
        let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
        let (x, y) = (mean(|p| p.0), mean(|p| p.1));
        let sum = |of: &dyn Fn(f64, f64) -> f64| points.iter().map(|p| of(p.0 - x, p.1 - y)).sum::<f64>();
        let (across, both, up) = (sum(&|x, _| x * x), sum(&|x, y| x * y), sum(&|_, y| y * y));
        Self {
            slope: both / across,
            explained: both * both / (across * up),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Line;

    #[test]
    fn a_line_is_found_again() {
        let exact = Line::through(&[(0.0, 1.0), (1.0, 3.0), (3.0, 7.0)]);
        assert!((exact.slope - 2.0).abs() < 1e-12 && (exact.explained - 1.0).abs() < 1e-12);
        let scattered = Line::through(&[(0.0, 0.0), (1.0, 2.0), (2.0, 1.0), (3.0, 3.0)]);
        assert!((scattered.slope - 0.8).abs() < 1e-12 && (scattered.explained - 0.64).abs() < 1e-12);
    }
}
