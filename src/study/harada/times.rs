//! Table 2: construction and whole steps, fixed grid against sliced grid and all others.

use std::rc::Rc;

use super::drops::Drop;
use super::{PAPER, Scale};
use crate::error::{Error, Result};
use crate::output::plot::Bars;
use crate::output::text::count;
use crate::study::bench::{Bench, LISTED, first_line, timed_names};
use crate::study::measure::{Entry, Outcome};
use crate::study::page::{Cell, Page, Table};
use crate::study::scenes;

/// The paper's fixed grid and its sliced grid.
pub const FIXED: &str = "uniform-pool";
pub const SLICED: &str = "sliced-pool";

/// Outcomes of every grid for each drop, with the grid's name.
pub type AllTimes = Vec<Vec<(String, Outcome)>>;

/// Times of grids, from the same scene's first state. Grids that the scene's checks refuse tell why.
pub fn of_grids(
    bench: &Bench,
    scale: &Scale,
    scene: &crate::scene::Scene,
    names: Vec<String>,
) -> Vec<(String, Outcome)> {
    let mut entries = Vec::new();
    let mut refused = Vec::new();
    for name in names {
        match scenes::with_grid(scene, &name) {
            Ok(scene) => entries.push(Entry { name, scene }),
            Err(error) => refused.push((name, Err(refusal(&error)))),
        }
    }
    let outcomes = bench.measure(&entries, scale.effort);
    let names = entries.into_iter().map(|entry| entry.name);
    names.zip(outcomes).chain(refused).collect()
}

/// Why a scene's checks refuse a grid: the problem, without file and place.
fn refusal(error: &Error) -> String {
    match error {
        Error::Scene { problems, .. } => problems
            .iter()
            .map(|p| p.what.clone())
            .collect::<Vec<_>>()
            .join("; "),
        other => first_line(other),
    }
}

/// Times of all grids for each drop when its sliced grid is widest.
pub fn of_drops(bench: &Bench, scale: &Scale, drops: &[Rc<Drop>]) -> Result<AllTimes> {
    let of_drop = |drop: &Rc<Drop>| {
        bench.check()?;
        let grains = count(drop.scene.capacity.into());
        bench.tell(&format!("harada: times of all grids, {grains} grains"));
        Ok(of_grids(
            bench,
            scale,
            &drop.at(&drop.widest),
            scale.timed(timed_names()),
        ))
    };
    drops.iter().map(of_drop).collect()
}

pub fn table_2(page: &mut Page, drops: &[Rc<Drop>], times: &AllTimes) -> Result<()> {
    page.heading("Table 2: construction and whole steps of grains");
    page.paragraph(
        "Each drop's state when its sliced grid is widest, stepped on with every grid. In the paper both grids are \
         pools of four indices per voxel: our `uniform-pool` and `sliced-pool`.",
    );
    let mut table = Table::new([
        "grains, paper",
        "construction ratio, paper",
        "step ratio, paper",
        "grains, ours",
        "construction, fixed, ms",
        "construction, sliced, ms",
        "construction ratio",
        "step, fixed, ms",
        "step, sliced, ms",
        "step ratio",
    ]);
    for ((drop, paper), times) in drops.iter().zip(&PAPER).zip(times) {
        let find = |name: &str| {
            times
                .iter()
                .find(|(grid, _)| grid == name)
                .and_then(|(_, o)| o.as_ref().ok())
        };
        let (fixed, sliced) = (find(FIXED), find(SLICED));
        let both = fixed.zip(sliced);
        table.row([
            Cell::count(paper.grains),
            Cell::number(paper.build[1] / paper.build[0]),
            Cell::number(paper.step[1] / paper.step[0]),
            Cell::count(drop.scene.capacity.into()),
            Cell::maybe(fixed.map(|t| t.build_ms)),
            Cell::maybe(sliced.map(|t| t.build_ms)),
            Cell::maybe(both.map(|(f, s)| s.build_ms / f.build_ms)),
            Cell::maybe(fixed.map(|t| t.step_ms)),
            Cell::maybe(sliced.map(|t| t.step_ms)),
            Cell::maybe(both.map(|(f, s)| s.step_ms / f.step_ms)),
        ]);
    }
    page.table("table_2", &table);
    page.paragraph("Every grid, milliseconds of construction / of a whole step:");
    page.table("table_2_all", &every_grid(drops, times));
    page.paragraph(format!(
        "Which grid is the fastest: the geometric mean over the four drops of a step's time as a multiple of \
         `{}`'s, which scenes get that do not choose; and the share of a step's passes that construction takes, on \
         average.",
        LISTED[0]
    ));
    page.table("winner", &winner(times));

    let there = |name: &str| {
        times
            .iter()
            .all(|one| one.iter().any(|(n, o)| n == name && o.is_ok()))
    };
    let names: Vec<String> = timed_names().into_iter().filter(|name| there(name)).collect();
    let mut chart = Bars::new(
        "One step, by grid",
        "ms",
        names.clone().into_iter().map(|n| n.replace(['-', '+'], "\n")),
    )
    .size(1400, 600)
    .log_y();
    for (drop, times) in drops.iter().zip(times) {
        let value = |name: &String| {
            let found = times.iter().find(|(n, _)| n == name);
            found
                .and_then(|(_, o)| o.as_ref().ok())
                .map_or(f64::NAN, |t| t.step_ms)
        };
        chart = chart.series(
            format!("{} grains", count(drop.scene.capacity.into())),
            names.iter().map(value),
        );
    }
    page.picture("harada_table_2.png", "Whole steps with every grid.", |path| {
        chart.save(path)
    })
}

/// Grids by the time of their steps, the fastest first.
fn winner(times: &AllTimes) -> Table {
    let found = |drop: &[(String, Outcome)], name: &str| {
        let (_, outcome) = drop.iter().find(|(known, _)| known == name)?;
        outcome.as_ref().ok().cloned()
    };
    let mut ranked = Vec::new();
    for (name, _) in &times[0] {
        let each = times.iter().map(|drop| {
            let (own, usual) = (found(drop, name)?, found(drop, LISTED[0])?);
            Some((
                own.step_ms / usual.step_ms,
                own.build_ms / (own.build_ms + own.query_ms()),
            ))
        });
        let Some(each) = each.collect::<Option<Vec<_>>>() else {
            continue;
        };
        let count = each.len() as f64;
        let step = (each.iter().map(|(step, _)| step.ln()).sum::<f64>() / count).exp();
        let share = each.iter().map(|(_, share)| share).sum::<f64>() / count;
        ranked.push((name, step, share));
    }
    ranked.sort_by(|a, b| a.1.total_cmp(&b.1));
    let mut table = Table::new(["grid", "step, multiple", "construction's share of the passes"]);
    for (name, step, share) in ranked {
        table.row([
            Cell::text(format!("`{name}`")),
            Cell::number(step),
            Cell::number(share),
        ]);
    }
    table
}

fn every_grid(drops: &[Rc<Drop>], times: &AllTimes) -> Table {
    let mut heads = vec!["grid".to_owned()];
    for drop in drops {
        let grains = count(drop.scene.capacity.into());
        heads.push(format!("{grains}: construction"));
        heads.push(format!("{grains}: step"));
    }
    heads.push("remark".into());
    let mut table = Table::new(heads);
    for (k, (name, _)) in times[0].iter().enumerate() {
        let outcomes: Vec<&Outcome> = times.iter().map(|one| &one[k].1).collect();
        let mut row = vec![Cell::text(format!("`{name}`"))];
        for outcome in &outcomes {
            let times = outcome.as_ref().ok();
            row.push(Cell::maybe(times.map(|t| t.build_ms)));
            row.push(Cell::maybe(times.map(|t| t.step_ms)));
        }
        let remark = outcomes.iter().find_map(|o| o.as_ref().err());
        row.push(remark.map_or(Cell::Nothing, Cell::text));
        table.row(row);
    }
    table
}
