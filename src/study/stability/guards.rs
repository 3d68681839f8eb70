//! What guards cost: the same scene with them and without, in turns.

use super::Scale;
use crate::error::Result;
use crate::output::text::count;
use crate::plan::Wanted;
use crate::study::bench::{Bench, first_line};
use crate::study::measure::Measured;
use crate::study::page::{Cell, Page, Table};
use crate::study::suite::scenes::SUBJECTS;

/// Steps of a turn.
const STEPS: u32 = 8;

pub fn cost(page: &mut Page, bench: &Bench, scale: &Scale) -> Result<()> {
    let (particles, turns) = scale.timed;
    page.heading("What guards cost");
    page.paragraph(format!(
        "Scenes of `sliceflow bench` with about {} particles, each twice: as it is, and without what the device does to watch \
         each particle in each step. The two take turns of {STEPS} steps, {turns} each, and who begins changes. Whatever else \
         the machine does only takes longer, so the fastest tenth of each one's turns is compared; *again* is the cost by odd \
         and by even turns alone, which says how far it can be trusted. Guards that the host has compare a few sums of a \
         frame, and take microseconds.",
        count(particles.into())
    ));
    let mut table = Table::new([
        "scene",
        "step, ms",
        "without guards, ms",
        "cost, %",
        "again, odd turns, %",
        "again, even turns, %",
    ]);
    for subject in SUBJECTS {
        bench.tell(&format!("stability: guards in {}", subject.name));
        match compared(bench, &(subject.scene)(particles)?, turns) {
            Ok([with, without, cost, odd, even]) => table.row([
                Cell::text(subject.name),
                Cell::number(with),
                Cell::number(without),
                Cell::number(100.0 * cost),
                Cell::number(100.0 * odd),
                Cell::number(100.0 * even),
            ]),
            Err(error) => {
                bench.check()?;
                let mut row = vec![Cell::text(subject.name), Cell::text(first_line(&error))];
                row.resize(6, Cell::Nothing);
                table.row(row);
            }
        }
    }
    page.table("guards", &table);
    Ok(())
}

/// A step with guards and without, ms; the cost as a share, by all turns and by every other one.
fn compared(bench: &Bench, scene: &crate::scene::Scene, turns: u32) -> Result<[f64; 5]> {
    let of = |unguarded: bool| {
        let wanted = Wanted {
            unguarded,
            ..Wanted::default()
        };
        Measured::wanting(bench, scene, STEPS, &wanted)
    };
    let mut both = [of(false)?, of(true)?];
    for turn in 0..turns as usize {
        for place in [turn % 2, 1 - turn % 2] {
            both[place].round(1)?;
        }
    }
    let [with, without] = both.map(|measured| measured.step_ms);
    let every = |first: usize, by: usize| {
        let turns = |all: &[f64]| fastest(all.iter().copied().skip(first).step_by(by).collect());
        turns(&with) / turns(&without) - 1.0
    };
    let cost = every(0, 1);
    Ok([
        fastest(with.clone()),
        fastest(without.clone()),
        cost,
        every(0, 2),
        every(1, 2),
    ])
}

/// Mean of the fastest tenth.
fn fastest(mut turns: Vec<f64>) -> f64 {
    turns.sort_by(f64::total_cmp);
    let tenth = turns.len().div_ceil(10);
    turns[..tenth].iter().sum::<f64>() / tenth as f64
}
