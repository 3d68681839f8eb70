//! `sliceflow study rojas`: the dam break of Rojas 2013 and how long it takes to compute.

use std::path::PathBuf;
use std::time::Instant;

use serde_json::{Value, json};

use super::bench::{Bench, first_line};
use super::page::{Cell, Page, Table};
use super::parts::{self, Part};
use super::{Settings, Size, scenes};
use crate::error::Result;
use crate::gpu::timing::median;
use crate::output::plot::Plot;
use crate::output::text::count;
use crate::plan::Wanted;
use crate::scene::Scene;
use crate::scene::model::View;

/// A way to simulate the dam: `fluid`'s keys beside spacing and density, the walls, and the search.
struct Way {
    name: &'static str,
    fluid: fn() -> Value,
    walls: &'static str,
    grid: &'static str,
}

/// Rojas' equations with his walls through his search and ours, and what `dam_break_2d` ships with.
const WAYS: [Way; 3] = [
    Way {
        name: "the paper's: summation, planes, bitonic sort",
        fluid: papers,
        walls: "planes",
        grid: "uniform-bitonic",
    },
    Way {
        name: "the paper's fluid, our search",
        fluid: papers,
        walls: "planes",
        grid: "sliced-counting+lists",
    },
    Way {
        name: "`dam_break_2d`: continuity, boundary particles",
        fluid: shipped,
        walls: "particles",
        grid: "sliced-counting+lists",
    },
];

/// Eq. 1 to 7 and the listing's viscosity.
fn papers() -> Value {
    json!({ "solver": "wcsph", "density_from": "summation", "pressure_force": "symmetric", "viscosity_form": "laplacian",
            "viscosity": 0.05, "artificial_viscosity": 0.05 })
}

fn shipped() -> Value {
    json!({ "solver": "wcsph", "viscosity": 0.05, "artificial_viscosity": 0.05 })
}

pub struct Scale {
    /// Particles along a side of the column of water.
    across: &'static [u32],
    /// Intervals that are timed.
    intervals: u32,
    /// Simulated seconds of an interval of the coarsest dam; as many steps make one of the finer dams.
    seconds: f64,
    /// Particles along a side, and the moment, s, of the picture.
    shown: (u32, f64),
}

impl Scale {
    fn interval(&self, across: u32) -> f64 {
        self.seconds * f64::from(self.across[0]) / f64::from(across)
    }
}

fn scale(size: Size) -> Scale {
    let (across, intervals, seconds, shown): (&[u32], _, _, _) = match size {
        Size::Tiny => (&[8, 16], 3, 0.002, (8, 0.05)),
        Size::Small => (&[32, 64, 128, 256], 8, 0.005, (64, 0.55)),
        Size::Full => (&[32, 64, 128, 256], 100, 0.08, (128, 0.55)),
    };
    Scale {
        across,
        intervals,
        seconds,
        shown,
    }
}

pub const PARTS: &[Part<Scale>] = &[
    Part {
        name: "figure_10",
        run: |page, bench, scale| ratios(page, bench, scale),
    },
    Part {
        name: "picture",
        run: |page, bench, scale| picture(page, bench, scale),
    },
];

pub fn rojas(settings: &Settings) -> Result<PathBuf> {
    let parts = parts::chosen("rojas", PARTS, &settings.cases)?;
    let title = "Rojas 2013, a dam break in the unit square, beside Sliceflow";
    let mut page = Page::create(&settings.folder, "rojas", title, settings.force)?;
    let bench = Bench::open(settings)?;
    let mut scale = scale(settings.size);
    page.paragraph(format!(
        "A square column of water, half a metre on a side, collapses in the unit square between no-slip walls. The \
         real-time ratio (RTR) is computing time over simulated time, as in the paper's Figure 10: one is real time, less \
         is faster. Each figure is the median over {} intervals after a first one that compiles shaders, without pictures; \
         an interval of the coarsest dam is {} s, and the others have as many steps, all of them early in the run. The figure's own values are not \
         printed in the paper as numbers, so none stand here.",
        scale.intervals, scale.seconds
    ));
    bench.environment(&mut page);
    parts::run(page, &bench, &mut scale, &parts, |_, _| {})
}

/// The dam for `frames` intervals of so many seconds.
fn dam(across: u32, way: &Way, frames: u32, seconds: f64) -> Result<Scene> {
    let mut file = json!({
        "name": format!("{} particles", across * across),
        "dimensions": 2,
        "domain": { "min": [0, 0], "max": [1, 1], "walls": way.walls },
        "fluid": (way.fluid)(),
        "bodies": [{ "shape": { "kind": "box", "min": [0, 0], "max": [0.5, 0.5] } }],
        "neighbors": { "skin": 0 },
        "time": { "duration": f64::from(frames) * seconds, "fps": 1.0 / seconds },
        "render": { "splat": "disc", "size": [640, 640], "color": { "by": "speed" } }
    });
    file["fluid"]["spacing"] = (0.5 / f64::from(across)).into();
    scenes::with_grid(&scenes::parse(&file)?, way.grid)
}

/// Wall time of each interval but the first, seconds.
fn times(bench: &Bench, scene: &Scene) -> Result<Vec<f64>> {
    let mut simulation = bench.simulation(scene, &Wanted::default())?;
    let mut seconds = Vec::new();
    for frame in 0..scene.time.frames {
        let start = Instant::now();
        simulation.next_frame()?;
        while simulation.finish_frame()?.is_some() {}
        // Frame 0 is the state at the start, and the first interval compiles shaders.
        if frame > 1 {
            seconds.push(start.elapsed().as_secs_f64());
        }
    }
    Ok(seconds)
}

fn ratios(page: &mut Page, bench: &Bench, scale: &Scale) -> Result<()> {
    page.heading("Figure 10: real-time ratio against particles");
    let mut table = Table::new([
        "way",
        "grid",
        "particles",
        "boundary particles",
        "time step, µs",
        "real-time ratio",
        "lowest",
        "highest",
        "million particle updates per second",
        "remark",
    ]);
    let mut chart = Plot::new(
        "A dam break in the unit square",
        "particles",
        "computing time over simulated time",
    )
    .log_x()
    .log_y()
    .mark_y(1.0, "real time");
    let mut rates = Plot::new("Speed", "particles", "million particle updates per second").log_x();
    for way in &WAYS {
        let mut points = Vec::new();
        let mut speeds = Vec::new();
        for &across in scale.across {
            let interval = scale.interval(across);
            let scene = dam(across, way, scale.intervals + 1, interval)?;
            let particles = scene.particles.len() as u64;
            bench.tell(&format!("rojas: {} particles, {}", count(particles), way.name));
            let outcome = times(bench, &scene).map_err(|error| first_line(&error));
            let ratio = |seconds: f64| seconds / interval;
            let seconds = outcome.as_ref().map_or(&[][..], Vec::as_slice);
            let middle = median(seconds.to_vec());
            let updates = particles as f64 * f64::from(scene.time.steps_per_frame) / middle / 1e6;
            let extreme = |pick: fn(f64, f64) -> f64| seconds.iter().copied().reduce(pick).map(ratio);
            table.row([
                Cell::text(way.name),
                Cell::text(format!("`{}`", way.grid)),
                Cell::count(particles),
                Cell::count(scene.boundary.len() as u64),
                Cell::number(scene.time.step * 1e6),
                Cell::number(ratio(middle)),
                Cell::maybe(extreme(f64::min)),
                Cell::maybe(extreme(f64::max)),
                Cell::number(updates),
                outcome.as_ref().err().map_or(Cell::Nothing, Cell::text),
            ]);
            points.push((particles as f64, ratio(middle)));
            speeds.push((particles as f64, updates));
        }
        let name = way.name.replace('`', "");
        chart = chart.series(name.clone(), points);
        rates = rates.series(name, speeds);
    }
    page.table("figure_10", &table);
    page.picture(
        "rojas_figure_10.png",
        "Real-time ratio against particles.",
        |path| chart.save(path),
    )?;
    page.paragraph(
        "The step follows the speed of sound and the spacing, so four times the particles take about eight times as long \
         where the device is busy. Boundary particles are searched like the others and count for none in the figures.",
    );
    page.picture("rojas_speed.png", "Particle updates per second.", |path| {
        rates.save(path)
    })
}

/// The shipped way in motion.
fn picture(page: &mut Page, bench: &Bench, scale: &Scale) -> Result<()> {
    let (across, moment) = scale.shown;
    bench.tell(&format!(
        "rojas: picture of {} particles",
        count(u64::from(across).pow(2))
    ));
    page.heading("The dam in motion");
    let scene = dam(across, &WAYS[2], 2, moment)?;
    let Some(picture) = bench.picture(&scene, View::Scene, 1)? else {
        return Ok(());
    };
    let caption = format!("The shipped way after {moment} s, colored by speed.");
    page.picture("rojas_dam.png", &caption, |path| {
        crate::output::write_file(path, &crate::output::encode_png(picture, path)?)
    })
}
