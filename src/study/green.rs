//! `sliceflow study green`: what Green 2012 compares, measured again.

use std::path::PathBuf;

use super::bench::Bench;
use super::measure::{Effort, Entry, Outcome, Times};
use super::page::{Cell, Page, Table};
use super::parts::{self, Part};
use super::scenes;
use super::{Settings, Size};
use crate::error::Result;
use crate::output::plot::Bars;
use crate::output::text::count;
use crate::scene::{Particles, Scene};

/// Frames a second of 65,536 colliding particles in the steady state (Green 2012, section Performance).
const PAPER: [(&str, f64); 2] = [("GeForce GTX 280", 175.0), ("GeForce GTX 480", 460.0)];

/// What the paper calls a way, and our name of the grid.
const WAYS: [(&str, &str); 6] = [
    ("atomics", "uniform-pool"),
    ("atomics, two passes (scan)", "uniform-counting"),
    ("two passes along a Z-order curve", "morton-counting"),
    ("radix sort", "uniform-radix"),
    ("radix sort along a Z-order curve", "morton-radix"),
    ("our default: two passes, neighbor lists", "sliced-counting+lists"),
];

pub struct Scale {
    /// Grains along a side of the floor; the bed has a quarter as many layers.
    columns: u32,
    effort: Effort,
    /// Frames that are drawn to find the rate.
    frames: u32,
    /// Steps before anything is measured, so that the bed settles.
    settle: u32,
}

fn scale(size: Size) -> Scale {
    let (columns, rounds, steps, frames, settle) = match size {
        Size::Tiny => (16, 1, 2, 4, 8),
        Size::Small => (64, 3, 8, 20, 200),
        Size::Full => (64, 21, 50, 1000, 5000),
    };
    Scale {
        columns,
        effort: Effort { rounds, steps },
        frames,
        settle,
    }
}

/// What parts share: the bed that all of them measure.
pub struct Shared {
    scale: Scale,
    bed: Scene,
}

pub const PARTS: &[Part<Shared>] = &[
    Part {
        name: "ways",
        run: |page, bench, shared| ways(page, bench, &shared.scale, &shared.bed),
    },
    Part {
        name: "deterministic",
        run: |page, bench, shared| deterministic(page, bench, &shared.scale, &shared.bed),
    },
    Part {
        name: "frames_per_second",
        run: |page, bench, shared| rate(page, bench, &shared.scale, &shared.bed),
    },
];

pub fn green(settings: &Settings) -> Result<PathBuf> {
    let parts = parts::chosen("green", PARTS, &settings.cases)?;
    let title = "Green 2012, *Particle Simulation using CUDA*, beside Sliceflow";
    let mut page = Page::create(&settings.folder, "green", title, settings.force)?;
    let bench = Bench::open(settings)?;
    let scale = scale(settings.size);
    let bed = settled_bed(&bench, &scale).map_err(parts::nothing_finished)?;
    let grains = count(bed.capacity.into());
    page.paragraph(format!(
        "A bed of {grains} grains at rest in a cube with clamping walls; spring, dashpot and shear act between grains, and \
         voxels are as wide as a grain, as in Green's sample. The paper's figures are from the text of its section Performance; everything else \
         was measured when this page was made{}.",
        match settings.size {
            Size::Full => "",
            Size::Small | Size::Tiny => ", with few repetitions",
        }
    ));
    bench.describe(&mut page, scale.effort);
    parts::run(page, &bench, &mut Shared { scale, bed }, &parts, |_, _| {})
}

/// Green's sample in the steady state: grains on the whole floor of a cube, after some steps.
fn settled_bed(bench: &Bench, scale: &Scale) -> Result<Scene> {
    bench.tell("green: a bed settles");
    let n = scale.columns;
    let mut file = scenes::base("green", [n; 3]);
    file["domain"]["walls"] = "clamp".into();
    file["domain"]["restitution"] = 0.5.into();
    file["render"]["size"] = serde_json::json!([640, 480]);
    file["render"]["show"]["slices"] = false.into();
    file["render"]["show"]["caption"] = false.into();
    file["render"]["camera"] = serde_json::json!({});
    // One grain a voxel in the lowest quarter.
    let scene = scenes::with_particles(&file, scenes::lattice([n, n / 4, n], |_| true))?;
    let mut last = scene.particles.clone();
    let mut run = scene.with_steps_per_frame(scale.settle);
    run.time.frames = 2;
    bench.run(&run, |_, particles| last = particles)?;
    Ok(scenes::replaced(&scene, last))
}

/// The two orders in which the state can stand when a run begins.
fn orders(scene: &Scene) -> [(&'static str, Particles); 2] {
    let side = 2.0 * scene.radius() as f32;
    let voxel = |p: glam::Vec3| {
        let [x, y, z] = ((p - scene.domain.min) / side)
            .to_array()
            .map(|x| x.floor() as i32);
        [y, z, x]
    };
    [
        ("cell order", scenes::sorted(&scene.particles, voxel)),
        ("random order", scenes::shuffled(&scene.particles)),
    ]
}

fn ways(page: &mut Page, bench: &Bench, scale: &Scale, bed: &Scene) -> Result<()> {
    page.heading("Building the grid: atomics, scan, sort; state in cell order and in random order");
    page.paragraph(
        "Green finds sorting fastest, because the state then stands in cell order, and atomics sensitive to a random \
         distribution. Here `pool` keeps the order in which a run begins; the other storages bring the state into cell \
         order in every step, so for them the beginning makes no difference after the first one.",
    );
    let orders = orders(bed);
    let mut entries = Vec::new();
    let mut labels = Vec::new();
    for (way, grid) in WAYS {
        for (order, particles) in &orders {
            labels.push((way, grid, *order));
            match scenes::with_grid(&scenes::replaced(bed, particles.clone()), grid) {
                Ok(scene) => entries.push(Some(Entry {
                    name: format!("{grid}, {order}"),
                    scene,
                })),
                Err(_) => entries.push(None),
            }
        }
    }
    bench.tell(&format!("green: times of {} grids and orders", entries.len()));
    let there: Vec<bool> = entries.iter().map(Option::is_some).collect();
    let entries: Vec<Entry> = entries.into_iter().flatten().collect();
    let mut outcomes = bench.measure(&entries, scale.effort).into_iter();
    let mut table = Table::new([
        "way",
        "grid",
        "state begins in",
        "construction, ms",
        "collisions and motion, ms",
        "step, ms",
        "lowest",
        "highest",
        "remark",
    ]);
    let mut bars: Vec<(String, Option<Times>)> = Vec::new();
    for ((way, grid, order), there) in labels.into_iter().zip(there) {
        let outcome: Outcome = match there {
            true => outcomes.next().expect("an outcome for each entry"),
            false => Err("this version has no such grid".into()),
        };
        let times = outcome.as_ref().ok();
        let [lowest, highest] = times.map_or([None; 2], |t| t.spread_ms.map(Some));
        table.row([
            Cell::text(way),
            Cell::text(format!("`{grid}`")),
            Cell::text(order),
            Cell::maybe(times.map(|t| t.build_ms)),
            Cell::maybe(times.map(Times::query_ms)),
            Cell::maybe(times.map(|t| t.step_ms)),
            Cell::maybe(lowest),
            Cell::maybe(highest),
            outcome.as_ref().err().map_or(Cell::Nothing, Cell::text),
        ]);
        bars.push((format!("{grid}\n{order}"), outcome.ok()));
    }
    page.table("ways", &table);
    bars.retain(|(_, times)| times.is_some());
    let value = |of: fn(&Times) -> f64| bars.iter().filter_map(move |(_, t)| t.as_ref().map(of));
    let chart = Bars::new("One step", "ms", bars.iter().map(|(name, _)| name.clone()))
        .series("construction", value(|t| t.build_ms))
        .series("collisions and motion", value(Times::query_ms))
        .series("whole step", value(|t| t.step_ms))
        .size(1200, 600);
    page.picture("green_ways.png", "Times of the ways to build the grid.", |path| {
        chart.save(path)
    })
}

/// Grids whose work is less with `neighbors.deterministic: false`.
const ORDERED: [&str; 3] = ["uniform-pool", "uniform-counting", "sliced-counting"];

fn deterministic(page: &mut Page, bench: &Bench, scale: &Scale, bed: &Scene) -> Result<()> {
    page.heading("What repeatable results cost");
    page.paragraph(
        "So that two runs give the same bytes, a voxel's particles come into one order before anything is summed. With \
         `neighbors.deterministic: false` they keep the order in which the device's threads arrived; `radix` and \
         `bitonic` are repeatable as they are. No lists: with them, the cost falls on the few steps that search.",
    );
    bench.tell("green: repeatable results");
    let [(_, sorted), _] = orders(bed);
    let bed = scenes::replaced(bed, sorted);
    let mut entries = Vec::new();
    for grid in ORDERED {
        for name in [grid.to_owned(), format!("{grid}{}", scenes::ANY_ORDER)] {
            let scene = scenes::with_grid(&bed, &name)?;
            entries.push(Entry { name, scene });
        }
    }
    let outcomes = bench.measure(&entries, scale.effort);
    let mut table = Table::new([
        "grid",
        "construction, one order, ms",
        "construction, any order, ms",
        "step, one order, ms",
        "step, any order, ms",
        "cost of a step, %",
    ]);
    for (grid, pair) in ORDERED.iter().zip(outcomes.chunks_exact(2)) {
        let [ordered, any] = [0, 1].map(|k| pair[k].as_ref().ok());
        let cost = ordered
            .zip(any)
            .map(|(o, a)| 100.0 * (o.step_ms / a.step_ms - 1.0));
        table.row([
            Cell::text(format!("`{grid}`")),
            Cell::maybe(ordered.map(|t| t.build_ms)),
            Cell::maybe(any.map(|t| t.build_ms)),
            Cell::maybe(ordered.map(|t| t.step_ms)),
            Cell::maybe(any.map(|t| t.step_ms)),
            Cell::maybe(cost),
        ]);
    }
    page.table("deterministic", &table);
    Ok(())
}

fn rate(page: &mut Page, bench: &Bench, scale: &Scale, bed: &Scene) -> Result<()> {
    page.heading("Frames per second");
    page.paragraph(
        "A frame of Green's sample is one step and one picture. Ours are 640 × 480 pixels, smoothed, with shadows, and \
         their pixels are brought back to the host; he draws point sprites into a window.",
    );
    bench.tell("green: frames per second");
    let [(_, sorted), _] = orders(bed);
    let bed = scenes::replaced(bed, sorted);
    let mut table = Table::new(["machine", "grid", "grains", "frames per second", "source"]);
    for (machine, rate) in PAPER {
        table.row([
            Cell::text(machine),
            Cell::text("radix sort"),
            Cell::count(65_536),
            Cell::number(rate),
            Cell::text("the paper"),
        ]);
    }
    for (_, grid) in WAYS {
        let Ok(scene) = scenes::with_grid(&bed, grid) else {
            continue;
        };
        let rate = bench.frames_per_second(&scene.with_steps_per_frame(1), scale.frames);
        table.row([
            Cell::text("this adapter"),
            Cell::text(format!("`{grid}`")),
            Cell::count(scene.capacity.into()),
            Cell::maybe(rate.ok()),
            Cell::text("measured, steps with drawing"),
        ]);
    }
    page.table("frames_per_second", &table);
    let picture = bench.picture(&bed, crate::scene::model::View::Scene, 0)?;
    if let Some(picture) = picture {
        page.picture(
            "green_bed.png",
            "The bed that is measured, colored by speed.",
            |path| crate::output::write_file(path, &crate::output::encode_png(picture, path)?),
        )?;
    }
    Ok(())
}
