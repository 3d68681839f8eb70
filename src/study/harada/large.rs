//! Figure 8: a large area.

use glam::Vec3;

use super::Scale;
use super::memory::Memory;
use crate::error::Result;
use crate::neighbors::ADDRESSINGS;
use crate::output::text::count;
use crate::plan::{Plan, Wanted};
use crate::scene::Scene;
use crate::study::bench::{Bench, first_line, main_names, rounds};
use crate::study::measure::{Effort, Entry};
use crate::study::page::{Cell, Page, Table};
use crate::study::scenes;

/// Voxels along x, y, z; y is up.
const AREA: [u32; 3] = [700, 256, 700];

/// Bytes that a voxel takes in the paper: four indices of four bytes.
const PAPER_VOXEL_BYTES: u64 = 16;

/// Hills of grains on the whole floor, one grain a voxel: about 8.2 layers on average, so 4 million at full size, and
/// up to 20 in the middle of a hill.
fn landscape(divisor: u32) -> Result<Scene> {
    let voxels = AREA.map(|n| n / divisor);
    let wave = |x: f32, n: u32| (x / n as f32 * 3.0 * std::f32::consts::TAU).sin();
    let layers = 20.0 / divisor as f32;
    let height = |v: Vec3| {
        let hill = (wave(v.x, voxels[0]) * wave(v.z, voxels[2]) + 1.0) / 2.0;
        layers * hill.powf(1.32)
    };
    let particles = scenes::lattice([voxels[0], layers.ceil() as u32, voxels[2]], |voxel| {
        voxel.y < height(voxel)
    });
    scenes::with_particles(&scenes::base("large", voxels), particles)
}

pub fn figure_8(page: &mut Page, bench: &Bench, scale: &Scale) -> Result<()> {
    page.heading("Figure 8: a large area");
    bench.tell("harada: a large area");
    let counted = landscape(scale.area_divisor)?;
    memory(page, &counted);
    let mut table = Table::new(["grid", "grains", "construction, ms", "step, ms", "remark"]);
    let effort = Effort { rounds: 3, steps: 2 };
    let runs = landscape(scale.large_divisor)?;
    for grid in scale.timed(main_names()) {
        run(&mut table, bench, &runs, grid, effort);
    }
    if scale.large_divisor > 1 {
        page.paragraph(format!(
            "On the device the same hills were stepped 1/{} as large along each side; `--scale full` steps them at full \
             size.",
            scale.large_divisor
        ));
    }
    page.paragraph(format!(
        "Steps on this adapter (medians of {} of {} steps). A grid that does not fit is refused by the plan with \
         the bytes that it would need.",
        rounds(effort.rounds), effort.steps
    ));
    page.table("figure_8_times", &table);
    Ok(())
}

/// Voxels and bytes at full size, counted on the host.
fn memory(page: &mut Page, scene: &Scene) {
    let position = &scene.particles.position;
    let [x, y, z] = (scene.domain.max - scene.domain.min)
        .to_array()
        .map(|side| (side / (2.0 * scenes::RADIUS as f32)).round());
    let memory = Memory::of(scene, position);
    page.paragraph(format!(
        "{} grains lie in hills on the floor of {x} × {z} × {y} voxels, counted on the host from the particles. \
         The paper, with about four million particles in \
         700 × 700 × 256 voxels: about 2 GB for a uniform grid, which it could not run, and about \
         150 MB for the sliced one, at four indices of four bytes per voxel; it does not say how its particles lay.",
        count(position.len() as u64),
    ));
    let mut table = Table::new([
        "addressing",
        "voxels",
        "four indices per voxel",
        "paper",
        "`counting`, all buffers",
    ]);
    for (row, voxels) in ADDRESSINGS.iter().zip(memory.voxels()) {
        let paper = match row.name {
            "uniform" => Cell::text("about 2 GB"),
            "sliced" => Cell::text("about 150 MB"),
            _ => Cell::Nothing,
        };
        table.row([
            Cell::text(format!("`{}`", row.name)),
            Cell::count(voxels),
            Cell::bytes(voxels * PAPER_VOXEL_BYTES),
            paper,
            Cell::bytes(memory.allocation(&format!("{}-counting", row.name)).bytes),
        ]);
    }
    table.row([
        Cell::text("octree's leaves, in `counting` with keys"),
        Cell::count(memory.octree.leaves),
        Cell::bytes(memory.octree.leaves * PAPER_VOXEL_BYTES),
        Cell::Nothing,
        Cell::bytes(memory.octree_bytes("counting")[1]),
    ]);
    page.table("figure_8_memory", &table);
}

/// Runs a grid, if this adapter can hold it.
fn run(table: &mut Table, bench: &Bench, scene: &Scene, grid: String, effort: Effort) {
    let planned = scenes::with_grid(scene, &grid)
        .and_then(|scene| Plan::new(&scene, &bench.limits, &Wanted::default()).map(|_| scene));
    let outcome = match planned {
        Ok(scene) => bench
            .measure(
                &[Entry {
                    name: grid.clone(),
                    scene,
                }],
                effort,
            )
            .remove(0),
        Err(error) => Err(first_line(&error)),
    };
    let times = outcome.as_ref().ok();
    table.row([
        Cell::text(format!("`{grid}`")),
        Cell::count(scene.capacity.into()),
        Cell::maybe(times.map(|t| t.build_ms)),
        Cell::maybe(times.map(|t| t.step_ms)),
        outcome.as_ref().err().map_or(Cell::Nothing, Cell::text),
    ]);
}
