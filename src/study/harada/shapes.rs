//! Bytes and times of every grid for shapes that suit some grids and not others.

use glam::Vec3;

use super::Scale;
use super::drops::Drop;
use super::memory::Memory;
use super::times::of_all_grids;
use crate::error::Result;
use crate::output::plot::Bars;
use crate::output::text::count;
use crate::scene::{Particles, Scene};
use crate::study::bench::{Bench, progress};
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
         construction.",
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
        "octree's leaves",
        "construction, ms",
        "query, ms",
        "step, ms",
        "remark",
    ]);
    let mut shares: Vec<(String, Vec<f64>)> = Vec::new();
    for (name, scene) in &scenes {
        progress(&format!(
            "harada: {name}, {} grains",
            count(scene.capacity.into())
        ));
        let memory = Memory::of(scene, &scene.particles.position);
        for (grid, outcome) in of_all_grids(bench, scale, scene) {
            let one = memory.allocation(&grid);
            let storage = grid.split_once('-').map_or("counting", |(_, storage)| storage);
            let uniform = memory.allocation(&format!("uniform-{storage}"));
            let times = outcome.as_ref().ok();
            table.row([
                Cell::text(*name),
                Cell::count(scene.capacity.into()),
                Cell::text(format!("`{grid}`")),
                Cell::count(one.voxels),
                Cell::bytes(one.bytes),
                Cell::number(one.bytes as f64 / uniform.bytes as f64),
                Cell::bytes(memory.octree_bytes(storage)[0]),
                Cell::maybe(times.map(|t| t.build_ms)),
                Cell::maybe(times.map(Times::query_ms)),
                Cell::maybe(times.map(|t| t.step_ms)),
                outcome.as_ref().err().map_or(Cell::Nothing, Cell::text),
            ]);
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
