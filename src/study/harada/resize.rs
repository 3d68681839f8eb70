//! Sizing the pool: once for all, with a margin, or exactly in every step.

use super::drops::Drop;
use crate::error::Result;
use crate::output::text::count;
use crate::study::bench::Bench;
use crate::study::measure::{Policy, Sized};
use crate::study::page::{Cell, Page, Table};
use crate::study::scenes;

/// Steps that policies run before the next one has its turn.
const TURN: u32 = 20;

pub fn resizing(page: &mut Page, bench: &Bench, drop: &Drop, steps: u32) -> Result<()> {
    page.heading("Resizing the pool");
    page.paragraph(format!(
        "The paper reads back one texel, the number of voxels, and could fit the pool to it in every step; it did not, \
         because allocation took longer than it saved. The second drop of Table 1 ({} grains), {} steps from its \
         beginning with `sliced-pool`, three policies in turns of {TURN} steps: a pool for every voxel of the cube, one \
         with a margin that grows when a search finds too little room, and one that is made anew after every step.",
        count(drop.scene.capacity.into()),
        count(steps.into()),
    ));
    bench.tell("harada: resizing the pool");
    let scene = scenes::with_grid(&drop.at(&drop.first), "sliced-pool")?;
    let policy = |name: &'static str, margin: f64, exactly: bool| {
        let mut scene = scene.clone();
        scene.neighbors.margin = margin;
        Policy { name, scene, exactly }
    };
    let policies = [
        policy("for all voxels", 1e6, false),
        policy("with a margin, grown when needed", scene.neighbors.margin, false),
        policy("exactly, in every step", 1.0, true),
    ];
    let mut table = Table::new(["policy", "step, ms", "times grown", "pool at the end", "remark"]);
    for (policy, outcome) in policies.iter().zip(bench.compare(&policies, steps / TURN, TURN)) {
        let sized: Option<&Sized> = outcome.as_ref().ok();
        table.row([
            Cell::text(policy.name),
            Cell::maybe(sized.map(|s| s.step_ms)),
            sized.map_or(Cell::Nothing, |s| Cell::count(s.reallocations.into())),
            sized.map_or(Cell::Nothing, |s| Cell::bytes(s.pool_bytes)),
            outcome.as_ref().err().map_or(Cell::Nothing, Cell::text),
        ]);
    }
    page.table("resizing", &table);
    Ok(())
}
