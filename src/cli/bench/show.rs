//! A benchmark as text.

use std::fmt::Write as _;

use crate::cli::table::Align::{Left, Right};
use crate::cli::table::Table;
use crate::output::text::{bytes, count, seconds, short};
use crate::study::suite::report::{Report, Run, Spread};

/// Everything that a report holds.
pub fn report(report: &Report) -> String {
    let mut text = head(report);
    let measured = !report.runs.is_empty();
    for table in [steps(report), passes(report), outputs(report)] {
        if measured {
            let _ = write!(text, "\n{table}");
        }
    }
    if !report.left_out.is_empty() {
        let mut table = Table::new([("left out", Left), ("particles", Right), ("why", Left)]);
        for row in &report.left_out {
            table.row([row.scene.clone(), count(row.particles.into()), row.why.clone()]);
        }
        let _ = write!(text, "\n{table}");
    }
    text + EXPLAINED
}

const EXPLAINED: &str = "
A step's time is the median of the rounds, with the shortest and the longest one. Pairs are neighbors in reach of water and
contacts of grains, each from both sides. Shares compare what a step must move and compute at least with what the two probes
reached on this device; what grids, and pairs out of reach, take comes on top.
";

/// What measured, and when.
pub fn head(report: &Report) -> String {
    let machine = &report.machine;
    let mut text = format!(
        "Sliceflow {}, bench of size {}, {}\n",
        report.sliceflow, report.size, report.date
    );
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "{name:<11}{value}");
    };
    line(
        "adapter",
        format!("{} ({}, {})", machine.adapter, machine.kind, machine.backend),
    );
    line("driver", machine.driver.clone());
    line(
        "processor",
        format!(
            "{}, {} threads, {}",
            machine.processor, machine.threads, machine.system
        ),
    );
    match &report.probes {
        Some(probes) => line(
            "probes",
            format!(
                "copies {}B/s ({} there and back), computes {}flop/s",
                short(probes.copy_bytes_per_s).trim_end(),
                bytes(probes.copied_bytes),
                short(probes.operations_per_s).trim_end()
            ),
        ),
        None => line("probes", "none: this adapter has no clock for passes".into()),
    }
    line(
        "took",
        format!(
            "{}{}",
            seconds(report.took_s),
            if report.interrupted { ", interrupted" } else { "" }
        ),
    );
    text
}

fn steps(report: &Report) -> Table {
    let mut table = Table::new([
        ("scene", Left),
        ("particles", Right),
        ("ms a step", Right),
        ("from", Right),
        ("to", Right),
        ("particle·steps/s", Right),
        ("pairs each", Right),
        ("pairs/s", Right),
        ("of copying", Right),
        ("of computing", Right),
        ("memory", Right),
    ]);
    for run in &report.runs {
        let Spread { median, least, most } = run.step_ms;
        table.row([
            run.scene.clone(),
            count(run.particles.into()),
            milliseconds(median),
            milliseconds(least),
            milliseconds(most),
            short(run.particle_steps_per_s),
            format!("{:.1}", run.pairs_per_particle),
            short(run.pairs_per_s),
            percent(run.copy_share),
            percent(run.arithmetic_share),
            bytes(run.device_bytes),
        ]);
    }
    table
}

/// The largest size of each scene.
fn passes(report: &Report) -> Table {
    let mut table = Table::new([
        ("scene", Left),
        ("particles", Right),
        ("pass", Left),
        ("ms a step", Right),
        ("share", Right),
        ("of copying", Right),
        ("of computing", Right),
    ]);
    let is_largest = |run: &&Run| {
        let others = report.runs.iter().filter(|other| other.scene == run.scene);
        others.map(|other| other.particles).max() == Some(run.particles)
    };
    for run in report.runs.iter().filter(is_largest) {
        let all: f64 = run.passes.iter().map(|pass| pass.ms).sum();
        let mut passes: Vec<_> = run.passes.iter().collect();
        passes.sort_by(|a, b| b.ms.total_cmp(&a.ms));
        // Small ones stand in the JSON.
        let shown: Vec<_> = passes.iter().filter(|pass| pass.ms >= SMALL * all).collect();
        for (place, pass) in shown.iter().enumerate() {
            let first = place == 0;
            table.row([
                if first { run.scene.clone() } else { String::new() },
                if first {
                    count(run.particles.into())
                } else {
                    String::new()
                },
                pass.name.clone(),
                milliseconds(pass.ms),
                percent(Some(pass.ms / all)),
                percent(pass.copy_share),
                percent(pass.arithmetic_share),
            ]);
        }
        let rest = passes.len() - shown.len();
        if rest > 0 {
            let ms: f64 = passes[shown.len()..].iter().map(|pass| pass.ms).sum();
            table.row([
                String::new(),
                String::new(),
                if rest == 1 {
                    "another".to_owned()
                } else {
                    format!("{rest} others")
                },
                milliseconds(ms),
                percent(Some(ms / all)),
                String::new(),
                String::new(),
            ]);
        }
    }
    table
}

/// Passes that take less of a step are summed.
const SMALL: f64 = 0.02;

fn outputs(report: &Report) -> Table {
    let mut table = Table::new([
        ("scene", Left),
        ("particles", Right),
        ("picture, ms", Right),
        ("PNG, ms", Right),
        ("figures and columns, ms", Right),
        ("set up, s", Right),
    ]);
    let maybe = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), milliseconds);
    for run in &report.runs {
        table.row([
            run.scene.clone(),
            count(run.particles.into()),
            maybe(run.outputs.picture_ms),
            maybe(run.outputs.png_ms),
            milliseconds(run.outputs.columns_ms),
            format!("{:.2}", run.setup_s),
        ]);
    }
    table
}

/// Three digits.
pub fn milliseconds(value: f64) -> String {
    let decimals = (2 - value.abs().max(1e-3).log10().floor() as i32).clamp(0, 4) as usize;
    format!("{value:.decimals$}")
}

fn percent(share: Option<f64>) -> String {
    share.map_or_else(|| "–".to_owned(), |share| format!("{:.1} %", 100.0 * share))
}
