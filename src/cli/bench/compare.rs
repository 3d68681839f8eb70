//! `sliceflow bench compare`

use std::path::PathBuf;

use crate::cli::stdout;
use crate::cli::table::Align::{Left, Right};
use crate::cli::table::Table;
use crate::error::{Error, Result};
use crate::output::text::count;
use crate::study::suite::report::{Report, Run};

use super::show::milliseconds;

/// Compares two benchmarks that --json wrote: medians, their ratio, and whether they differ by more than they spread
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  sliceflow bench compare before.json after.json")]
pub struct Args {
    /// What to compare with
    before: PathBuf,
    /// What is compared
    after: PathBuf,
}

pub fn main(args: &Args) -> Result<()> {
    let [before, after] = [&args.before, &args.after].map(|path| Report::read(path));
    stdout::print(&compared(&before?, &after?)?)
}

fn compared(before: &Report, after: &Report) -> Result<String> {
    let same = |a: &Run, b: &Run| a.scene == b.scene && a.particles == b.particles;
    let mut table = Table::new([
        ("scene", Left),
        ("particles", Right),
        ("before, ms a step", Right),
        ("after, ms a step", Right),
        ("speed", Right),
        ("verdict", Left),
    ]);
    for a in &before.runs {
        let Some(b) = after.runs.iter().find(|b| same(a, b)) else {
            continue;
        };
        let ratio = a.step_ms.median / b.step_ms.median;
        let verdict = match (a.step_ms.is_apart(&b.step_ms), ratio > 1.0) {
            (false, _) => "within the spread",
            (true, true) => "faster",
            (true, false) => "slower",
        };
        let spread = |run: &Run| {
            let spread = run.step_ms;
            let [median, least, most] = [spread.median, spread.least, spread.most].map(milliseconds);
            format!("{median} ({least} to {most})")
        };
        table.row([
            a.scene.clone(),
            count(a.particles.into()),
            spread(a),
            spread(b),
            format!("× {ratio:.2}"),
            verdict.to_owned(),
        ]);
    }
    if table.is_empty() {
        return Err(Error::usage(
            "the two benchmarks have no scene and size in common",
            "compare benchmarks of the same --size and --scene",
        ));
    }
    let name = |report: &Report| {
        format!(
            "{}, Sliceflow {}, {}",
            report.machine.name(),
            report.sliceflow,
            report.date
        )
    };
    let mut text = format!("before  {}\nafter   {}\n\n{table}", name(before), name(after));
    let only = |these: &Report, those: &Report| -> Vec<String> {
        let alone = these
            .runs
            .iter()
            .filter(|a| !those.runs.iter().any(|b| same(a, b)));
        alone
            .map(|run| format!("{} of {}", run.scene, count(run.particles.into())))
            .collect()
    };
    for (which, runs) in [("before", only(before, after)), ("after", only(after, before))] {
        if !runs.is_empty() {
            text += &format!("\nonly in {which}: {}\n", runs.join(", "));
        }
    }
    Ok(
        text + "\nSpeed is how many times as fast the second one is. It differs where no round of one took as long as a round of the other.\n"
    )
}
