//! Table 3: steps of fluids with the fixed grid and the sliced grid, and what both need memory for.

use glam::Vec3;
use serde_json::json;

use super::Scale;
use super::memory::Memory;
use super::times::{FIXED, SLICED, of_grids};
use crate::error::Result;
use crate::neighbors::ADDRESSINGS;
use crate::output::text::count;
use crate::scene::Scene;
use crate::study::bench::{Bench, LISTED};
use crate::study::page::{Cell, Page, Table};
use crate::study::scenes;

/// Harada 2007, Table 3: particles, and milliseconds of a step with the fixed grid and with the sliced one.
const PAPER: [(u64, f64, f64); 4] = [
    (65_536, 60.9, 53.1),
    (262_144, 280.5, 231.3),
    (589_824, 685.9, 567.9),
    (1_048_576, 1160.9, 1070.3),
];
/// Voxels along a side of the paper's tank.
const PAPER_TANK: u32 = 256;
/// Particles along x and z of the dams in such a tank; all are 64 high.
const COLUMNS: [u32; 4] = [32, 64, 96, 128];
const LAYERS: u32 = 64;
/// Spacings along a side of a voxel that is half a support wide.
const VOXEL: f64 = 1.3;
/// So many particles at rest fit into such a voxel, and as many indices.
const SLOTS: u32 = 8;
/// Indices of the paper's voxels, and their bytes.
const PAPER_VOXEL: u64 = 4 * 4;

/// A dam in the corner of a cube of `tank`³ voxels, 1 m wide.
fn dam(tank: u32, columns: u32, layers: u32, steps: u32) -> Result<Scene> {
    let spacing = 1.0 / (VOXEL * f64::from(tank));
    // A little more, so that rounding takes no layer away.
    let along = |n: u32| (f64::from(n) + 1e-3) * spacing;
    let scene = scenes::parse(&json!({
        "name": "table 3",
        "domain": { "min": [0, 0, 0], "max": [1, 1, 1], "walls": "planes" },
        "fluid": {
            "solver": "sph", "spacing": spacing, "support": 2.0 * VOXEL, "viscosity": 0.1, "artificial_viscosity": 0.1
        },
        "bodies": [
            { "shape": { "kind": "box", "min": [0, 0, 0], "max": [along(columns), along(layers), along(columns)] } }
        ],
        "neighbors": { "cell": "half", "slots": SLOTS, "slicing_axis": "y", "skin": 0 },
        "time": { "fps": 1000 }
    }))?;
    let mut scene = scene.with_steps_per_frame(steps);
    scene.time.frames = 2;
    Ok(scene)
}

/// The dam after its steps.
fn fallen(bench: &Bench, scene: &Scene) -> Result<Scene> {
    let mut last = scene.particles.clone();
    bench.run(scene, |_, particles| last = particles)?;
    Ok(scenes::replaced(scene, last))
}

pub fn table_3(page: &mut Page, bench: &Bench, scale: &Scale) -> Result<()> {
    page.heading("Table 3: fluids");
    page.paragraph(format!(
        "Dams of `sph` (Müller 2003, as in the paper) in a cube of {0}³ voxels{1}, stepped on after {2} steps. \
         The walls are planes, which need no particles. Voxels are half a support wide, {VOXEL} spacings, and pools have \
         {SLOTS} indices per voxel, as many as particles at rest can need there; the paper has four. A particle looks at \
         125 voxels then. The default grid has neighbor lists.",
        scale.tank,
        match scale.tank {
            PAPER_TANK => "",
            _ => "; the paper has 256³, and the dams are smaller by the same factor along each side",
        },
        scale.tank_steps
    ));
    let mut table = Table::new([
        "particles, paper",
        "fixed, paper, ms",
        "sliced, paper, ms",
        "ratio, paper",
        "particles, ours",
        "`uniform-pool`, ms",
        "`sliced-pool`, ms",
        "ratio",
        "default, ms",
        "default over `uniform-pool`",
        "remark",
    ]);
    for (&(particles, fixed, sliced), columns) in PAPER.iter().zip(COLUMNS) {
        let part = |n: u32| n * scale.tank / PAPER_TANK;
        let scene = dam(scale.tank, part(columns), part(LAYERS), scale.tank_steps)?;
        let grains = u64::from(scene.capacity);
        bench.tell(&format!("harada: a dam of {} particles", count(grains)));
        let names = [FIXED, SLICED, LISTED[0]].map(str::to_owned).to_vec();
        let outcomes = of_grids(bench, scale, &fallen(bench, &scene)?, names);
        let step = |name: &str| {
            let (_, outcome) = outcomes.iter().find(|(grid, _)| grid == name)?;
            outcome.as_ref().ok().map(|times| times.step_ms)
        };
        let ratio = |name: &str| step(name).zip(step(FIXED)).map(|(ours, fixed)| ours / fixed);
        let remark = outcomes.iter().find_map(|(_, outcome)| outcome.as_ref().err());
        table.row([
            Cell::count(particles),
            Cell::number(fixed),
            Cell::number(sliced),
            Cell::number(sliced / fixed),
            Cell::count(grains),
            Cell::maybe(step(FIXED)),
            Cell::maybe(step(SLICED)),
            Cell::maybe(ratio(SLICED)),
            Cell::maybe(step(LISTED[0])),
            Cell::maybe(ratio(LISTED[0])),
            remark.map_or(Cell::Nothing, Cell::text),
        ]);
    }
    page.table("table_3", &table);
    memory(page)
}

/// Counted on the host for the paper's largest dam, at rest and as wide as its tank.
fn memory(page: &mut Page) -> Result<()> {
    page.paragraph(
        "Memory of voxels with four indices of four bytes each, counted at the paper's size, 1,048,576 particles in 256³ \
         voxels: the dam as it begins, and the same water at rest on the whole floor. A splash that throws particles high \
         widens the slices above, and needs more than either. The paper's sliced grid needed at most 15 MB.",
    );
    let [columns] = COLUMNS[3..] else {
        unreachable!("the last of four")
    };
    // Few particles make the scene; the positions are counted.
    let scene = dam(PAPER_TANK, 2, 2, 1)?;
    let spacing = 1.0 / (VOXEL * f64::from(PAPER_TANK));
    let across = (VOXEL * f64::from(PAPER_TANK)) as u32;
    let particles = columns * columns * LAYERS;
    let filled = |x: u32, z: u32| -> Vec<Vec3> {
        let place = |n: u32| ((f64::from(n) + 0.5) * spacing) as f32;
        (0..particles)
            .map(|i| Vec3::new(place(i % x), place(i / (x * z)), place(i / x % z)) + scene.domain.min)
            .collect()
    };
    let states = [filled(columns, columns), filled(across, across)];
    let voxels = states
        .each_ref()
        .map(|positions| Memory::of(&scene, positions).voxels());
    let mut table = Table::new(["256³ voxels", "paper", "dam", "level"]);
    for (k, row) in ADDRESSINGS.iter().enumerate() {
        let paper = match row.name {
            "uniform" => Cell::text("256 MB"),
            "sliced" => Cell::text("at most 15 MB"),
            _ => Cell::Nothing,
        };
        let bytes = |state: usize| Cell::bytes(voxels[state][k] * PAPER_VOXEL);
        table.row([Cell::text(format!("`{}`", row.name)), paper, bytes(0), bytes(1)]);
    }
    page.table("table_3_memory", &table);
    Ok(())
}
