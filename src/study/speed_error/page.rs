//! The page of the study.

use super::peers::{Outcome, Told};
use super::rung::Rung;
use super::{Ladder, on_front};
use crate::error::Result;
use crate::output::plot::Plot;
use crate::output::text::seconds;
use crate::study::Size;
use crate::study::page::{Cell, Page, Table};

const DIAGRAM: (u32, u32) = (1280, 720);
/// More labels would cover each other.
const MOST_LABELS: usize = 8;

/// What is measured, and how.
pub fn about(size: Size, limit: f64, repeats: u32) -> String {
    let time = match size {
        Size::Tiny | Size::Full => String::new(),
        Size::Small => format!(
            " A case takes {} at most: rungs that have not begun by then are left out and named, and runs are not repeated \
             any more.",
            seconds(limit)
        ),
    };
    format!(
        "Each case runs with both solvers at several resolutions, and at the middle one with each other choice changed alone: \
         support, kernel, integrator, length of a step, lists. Wall seconds per simulated second are medians of up to {repeats} \
         runs with the shortest and the longest one beside, without what compiled the shaders; errors are the same in every \
         run. Pairs are particles in reach at the start, boundary particles included, each from both sides. The front \
         (Pareto's) is what no other row beats in time and in error.{time}"
    )
}

/// One case.
pub fn ladder(page: &mut Page, ladder: &Ladder, adapter: &str) -> Result<()> {
    let (subject, case) = (ladder.subject, &ladder.subject.case);
    page.heading(case.title);
    page.paragraph(case.about);
    page.paragraph(format!(
        "Here the error is the magnitude of “{}”, in percent.",
        subject.figure
    ));
    let best: Vec<_> = on_front(&ladder.rungs).iter().map(|rung| key(rung)).collect();
    let mut table = Table::new([
        "way",
        case.resolution,
        "particles",
        "steps",
        "wall s per simulated s",
        "shortest",
        "longest",
        "runs",
        "particle·steps/s",
        "pairs/s",
        "error, %",
        "front",
        "remark",
    ]);
    for rung in &ladder.rungs {
        let spread = rung.spread();
        table.row([
            Cell::text(rung.name.as_str()),
            Cell::text((case.label)(rung.resolution)),
            Cell::count(rung.particles.into()),
            Cell::count(rung.steps),
            Cell::maybe(rung.wall_per_simulated()),
            Cell::maybe(spread.map(|[shortest, _]| shortest)),
            Cell::maybe(spread.map(|[_, longest]| longest)),
            Cell::count(rung.wall.len() as u64),
            rounded(rung.particle_steps_per_s()),
            rounded(rung.pairs_per_s()),
            Cell::maybe(rung.error),
            match best.contains(&key(rung)) {
                true => Cell::text("yes"),
                false => Cell::Nothing,
            },
            rung.trouble.as_deref().map_or(Cell::Nothing, Cell::text),
        ]);
    }
    page.table(case.name, &table);
    if !ladder.left_out.is_empty() {
        page.paragraph(format!(
            "Left out for want of time: {}.",
            ladder.left_out.join("; ")
        ));
    }
    peers(page, ladder);
    match diagram(ladder, adapter) {
        Some(plot) => page.picture(
            &format!("speed-error_{}.png", case.name),
            &format!("{}: error against time.", case.title),
            |path| {
                plot.save(path)?;
                plot.save(&path.with_extension("svg"))
            },
        ),
        None => {
            page.paragraph("No run has a result to draw.");
            Ok(())
        }
    }
}

fn key(rung: &Rung) -> (String, u32) {
    (rung.name.clone(), rung.resolution)
}

/// Three digits, without those that mean nothing.
fn rounded(value: Option<f64>) -> Cell {
    let Some(value) = value.filter(|value| value.is_finite()) else {
        return Cell::Nothing;
    };
    let unit = 10f64.powi((value.abs().max(1.0).log10().floor() as i32 - 2).max(0));
    Cell::count(((value / unit).round() * unit) as u64)
}

fn peers(page: &mut Page, ladder: &Ladder) {
    let case = &ladder.subject.case;
    for (program, outcome) in &ladder.peers {
        match outcome {
            Outcome::Missing(why) => page.paragraph(format!("{program} was not measured beside: {why}.")),
            Outcome::Ran(all) => {
                let mut table = Table::new([
                    "other program",
                    "method",
                    case.resolution,
                    "particles",
                    "steps",
                    "wall s per simulated s",
                    "runs",
                    "error, %",
                ]);
                for told in all {
                    table.row([
                        Cell::text(told.program.as_str()),
                        Cell::text(told.method.as_str()),
                        Cell::text((case.label)(told.resolution)),
                        Cell::count(told.particles.into()),
                        Cell::count(told.steps),
                        Cell::number(told.wall / told.simulated),
                        Cell::count(told.runs.into()),
                        Cell::maybe(told.error),
                    ]);
                }
                page.table(&format!("{}_{}", case.name, program.to_lowercase()), &table);
                page.paragraph("`assets/peers/` has the scripts that ran them, with all settings.");
            }
        }
    }
    if ladder.peers.is_empty() {
        page.paragraph("No other program is measured beside in this case.");
    }
}

/// Error over time: both solvers as lines, other choices as points, the front, and what others reach.
fn diagram(ladder: &Ladder, adapter: &str) -> Option<Plot> {
    let case = &ladder.subject.case;
    let front = on_front(&ladder.rungs);
    if front.is_empty() {
        return None;
    }
    let mut plot = Plot::new(
        format!(
            "{}: error against time on {}",
            case.title,
            adapter.split(" (").next().unwrap_or(adapter)
        ),
        "wall seconds per simulated second",
        format!("{}, %", ladder.subject.figure),
    )
    .size(DIAGRAM.0, DIAGRAM.1)
    .log_x()
    .log_y();
    let place = |rung: &Rung| rung.point().map(|[time, error]| (time, error));
    // Below the others, whose markers say what it goes through.
    plot = plot.series("front", front.iter().filter_map(|rung| place(rung)));
    if front.len() <= MOST_LABELS {
        let short = |rung: &&Rung| match rung.name.split_once(", ") {
            // Both solvers have their labels already.
            None => String::new(),
            Some((solver, choice)) => format!("{choice} ({solver})"),
        };
        plot = plot.labelled(front.iter().map(short));
    }
    for solver in ["wcsph", "dfsph"] {
        let of = |plain: bool| {
            let wanted = move |rung: &&Rung| {
                rung.name.starts_with(solver) && (rung.name == solver) == plain && rung.point().is_some()
            };
            ladder.rungs.iter().filter(wanted)
        };
        if of(true).next().is_some() {
            plot = plot
                .series(solver, of(true).filter_map(place))
                .labelled(of(true).map(|rung| (case.label)(rung.resolution)));
        }
        if of(false).next().is_some() {
            plot = plot.points(
                format!("{solver}, one choice changed"),
                of(false).filter_map(place),
            );
        }
    }
    for (program, outcome) in &ladder.peers {
        if let Outcome::Ran(all) = outcome {
            plot = with_peer(plot, program, all, case.label);
        }
    }
    Some(plot)
}

/// A series for each method.
fn with_peer(mut plot: Plot, program: &str, all: &[Told], label: fn(u32) -> String) -> Plot {
    let mut methods: Vec<&str> = all.iter().map(|told| told.method.as_str()).collect();
    methods.sort_unstable();
    methods.dedup();
    for method in methods {
        let runs: Vec<_> = all
            .iter()
            .filter(|told| told.method == method && told.error.is_some())
            .collect();
        let points = runs
            .iter()
            .filter_map(|told| Some((told.wall / told.simulated, told.error?)));
        plot = plot
            .points(format!("{program}, {method}"), points)
            .labelled(runs.iter().map(|told| label(told.resolution)));
    }
    plot
}

/// What stands below all cases: the fronts.
pub fn end(page: &mut Page, ladders: &[Ladder]) {
    page.heading("What nobody beats");
    let mut table = Table::new(["case", "way", "resolution", "wall s per simulated s", "error, %"]);
    for ladder in ladders {
        let case = &ladder.subject.case;
        for rung in on_front(&ladder.rungs) {
            table.row([
                Cell::text(case.name),
                Cell::text(rung.name.as_str()),
                Cell::text((case.label)(rung.resolution)),
                Cell::maybe(rung.wall_per_simulated()),
                Cell::maybe(rung.error),
            ]);
        }
    }
    page.table("front", &table);
    page.paragraph(
        "`achieved.json` beside this page holds these rows for `sliceflow plan SCENE --error 2% --results achieved.json`.",
    );
    let rungs: Vec<_> = ladders.iter().flat_map(|ladder| &ladder.rungs).collect();
    page.value("rungs", serde_json::to_value(rungs).expect("numbers and text"));
}
