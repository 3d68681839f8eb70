//! Bytes and times of every grid for shapes that suit some grids and not others.

use glam::Vec3;

use super::Scale;
use super::drops::Drop;
use super::memory::Memory;
use super::times::of_grids;
use crate::error::Result;
use crate::output::plot::Bars;
use crate::output::text::count;
use crate::scene::{Particles, Scene};
use crate::study::bench::{Bench, LISTED, main_names};
use crate::study::measure::Times;
use crate::study::page::{Cell, Page, Table};
use crate::study::scenes;

/// Shapes of one grain a voxel in a cube of `cells`³ voxels.
fn made(cells: u32) -> Vec<(&'static str, Particles)> {
    let n = cells as f32;
    let filled = |inside: &dyn Fn(Vec3) -> bool| scenes::lattice([cells; 3], inside);
    let blob = |at: f32| move |v: Vec3| (v - Vec3::splat(at * n)).length() < 0.12 * n;
    let (low, high) = (blob(0.15), blob(0.85));
    vec![
        ("full tank", filled(&|_| true)),
        ("two blobs far apart", filled(&|v| low(v) || high(v))),
        // Tilted against all axes.
        ("thin sheet", filled(&|v| (2.0 * v.y - v.x - v.z).abs() < 1.0)),
        (
            "diagonal line",
            filled(&|v| v.x.floor() == v.y.floor() && v.y.floor() == v.z.floor()),
        ),
    ]
}

pub fn shapes(page: &mut Page, bench: &Bench, scale: &Scale, splash: &Drop) -> Result<()> {
    page.heading("Shapes that suit some grids");
    page.paragraph(format!(
        "The cube of {0}³ voxels with: a grain in every voxel; the second drop when its sliced grid is widest; two balls in \
         opposite corners; a sheet one voxel thick, tilted against all axes; and a line from corner to corner. Bytes are \
         those of the search's buffers, as large as the state needs them. A query is what a step does besides \
         construction. Grids with a pool keep four particles per voxel and may overflow; with `+lists`, bytes include the \
         lists.",
        scale.cells
    ));
    let mut scenes: Vec<(&str, Scene)> = Vec::new();
    for (name, particles) in made(scale.cells) {
        scenes.push((
            name,
            scenes::with_particles(&scenes::base(name, [scale.cells; 3]), particles)?,
        ));
    }
    scenes.insert(1, ("splash", splash.at(&splash.widest)));

    let mut table = Table::new([
        "shape",
        "grains",
        "grid",
        "voxels",
        "bytes",
        "share of `uniform`",
        "octree's leaves with keys",
        "construction, ms",
        "query, ms",
        "step, ms",
        "remark",
    ]);
    let mut ranks = Vec::new();
    let mut shares: Vec<(String, Vec<f64>)> = Vec::new();
    for (name, scene) in &scenes {
        bench.tell(&format!(
            "harada: {name}, {} grains",
            count(scene.capacity.into())
        ));
        let memory = Memory::of(scene, &scene.particles.position);
        for (grid, outcome) in of_grids(bench, scale, scene, scale.timed(main_names())) {
            let one = memory.allocation(&grid);
            let bytes = memory.bytes(&grid);
            let storage = if grid.ends_with("-pool") {
                "pool"
            } else {
                "counting"
            };
            let uniform = memory.allocation(&format!("uniform-{storage}"));
            let times = outcome.as_ref().ok();
            table.row([
                Cell::text(*name),
                Cell::count(scene.capacity.into()),
                Cell::text(format!("`{grid}`")),
                Cell::count(one.voxels),
                Cell::bytes(bytes),
                Cell::number(bytes as f64 / uniform.bytes as f64),
                Cell::bytes(memory.octree_bytes(storage)[1]),
                Cell::maybe(times.map(|t| t.build_ms)),
                Cell::maybe(times.map(Times::query_ms)),
                Cell::maybe(times.map(|t| t.step_ms)),
                outcome.as_ref().err().map_or(Cell::Nothing, Cell::text),
            ]);
            ranks.push((*name, grid.clone(), bytes, times.map(|t| (t.build_ms, t.step_ms))));
            if storage == "pool" {
                let addressing = grid.trim_end_matches("-pool").to_owned();
                let percent = 100.0 * one.voxels as f64 / memory.domain_voxels as f64;
                match shares.iter_mut().find(|(known, _)| *known == addressing) {
                    Some((_, values)) => values.push(percent),
                    None => shares.push((addressing, vec![percent])),
                }
            }
        }
    }
    page.table("shapes", &table);
    page.paragraph("The best of these, shape by shape (bytes among grids without lists, which are exact):");
    page.table("shapes_best", &best(&ranks));
    let mut chart = Bars::new(
        "Voxels with memory",
        "% of all voxels",
        scenes.iter().map(|(name, _)| *name),
    )
    .log_y();
    for (addressing, values) in shares {
        chart = chart.series(addressing, values);
    }
    page.picture("harada_shapes.png", "Voxels of each addressing.", |path| {
        chart.save(path)
    })
}

/// Shape, grid, bytes, milliseconds of construction and step.
type Rank<'a> = (&'a str, String, u64, Option<(f64, f64)>);

fn best(ranks: &[Rank<'_>]) -> Table {
    let mut table = Table::new([
        "shape",
        "fewest bytes",
        "bytes",
        "fastest construction",
        "ms",
        "fastest step",
        "step, ms",
        "step of the default, ms",
    ]);
    for same in ranks.chunk_by(|a, b| a.0 == b.0) {
        let exact = same.iter().filter(|rank| rank.1.ends_with("-counting"));
        let fewest = exact.min_by_key(|rank| rank.2);
        let timed = || same.iter().filter_map(|rank| Some((&rank.1, rank.3?)));
        let built = timed().min_by(|a, b| a.1.0.total_cmp(&b.1.0));
        let stepped = timed().min_by(|a, b| a.1.1.total_cmp(&b.1.1));
        let usual = timed().find(|(name, _)| *name == LISTED[0]);
        let name =
            |found: Option<&String>| found.map_or(Cell::Nothing, |name| Cell::text(format!("`{name}`")));
        table.row([
            Cell::text(same[0].0),
            name(fewest.map(|rank| &rank.1)),
            fewest.map_or(Cell::Nothing, |rank| Cell::bytes(rank.2)),
            name(built.map(|found| found.0)),
            Cell::maybe(built.map(|found| found.1.0)),
            name(stepped.map(|found| found.0)),
            Cell::maybe(stepped.map(|found| found.1.1)),
            Cell::maybe(usual.map(|found| found.1.1)),
        ]);
    }
    table
}
