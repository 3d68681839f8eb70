//! `sliceflow bench`

mod compare;
mod show;

use std::path::{Path, PathBuf};

use clap::Subcommand;

use super::device_args::DeviceArgs;
use super::quiet_args::QuietArgs;
use super::stdout;
use crate::error::{Error, Result};
use crate::output::write_file;
use crate::study::suite::report::Report;
use crate::study::suite::scenes::SUBJECTS;
use crate::study::suite::{self, Settings};

/// Measures how fast this machine computes a fixed set of scenes, to compare machines, drivers and versions
///
/// Water at rest and splashing, grains settled and falling, in 3D and 2D, from 16,384 to 4,194,304 particles: what fits
/// the adapter and the time; the rest is listed with the reason. Ten minutes at most, and nothing else should compute
/// meanwhile. Ctrl-C ends it and keeps what was finished.
#[derive(clap::Args)]
#[command(after_help = after_help(), args_conflicts_with_subcommands = true)]
pub struct Args {
    #[command(subcommand)]
    command: Option<Command>,
    /// `quick` is 16,384 particles alone; `full` goes through all sizes, however long that takes
    #[arg(long, value_name = "SIZE", default_value = "default")]
    size: Size,
    /// The same as --size quick
    #[arg(long, conflicts_with = "size")]
    quick: bool,
    /// Measures this scene alone (named below); may be given again
    #[arg(long = "scene", value_name = "SCENE")]
    scenes: Vec<String>,
    /// Writes all figures to this file too
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Replaces that file where it is there
    #[arg(long, requires = "json")]
    force: bool,
    #[command(flatten)]
    device: DeviceArgs,
    #[command(flatten)]
    quiet: QuietArgs,
}

#[derive(Subcommand)]
enum Command {
    Compare(compare::Args),
}

#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum Size {
    #[value(hide = true)]
    Tiny,
    Quick,
    Default,
    Full,
}

const EXAMPLES: &str = "\
Examples:
  sliceflow bench                                         ten minutes at most
  sliceflow bench --quick --json today.json
  sliceflow bench --scene grains_settled --size full --adapter 0
  sliceflow bench compare before.json today.json";

fn after_help() -> String {
    let scene = |row: &suite::scenes::Subject| format!("  {:<20}{}\n", row.name, row.about);
    format!(
        "Scenes:\n{}\n{EXAMPLES}",
        SUBJECTS.iter().map(scene).collect::<String>()
    )
}

pub fn main(args: &Args) -> Result<()> {
    if let Some(Command::Compare(args)) = &args.command {
        return compare::main(args);
    }
    if let Some(path) = args.json.as_deref().filter(|path| path.exists() && !args.force) {
        return Err(Error::usage(
            format!("{} exists already", path.display()),
            "replace it with --force, or name another file with --json",
        ));
    }
    let settings = Settings {
        size: match args.size {
            _ if args.quick => suite::Size::Quick,
            Size::Tiny => suite::Size::Tiny,
            Size::Quick => suite::Size::Quick,
            Size::Default => suite::Size::Default,
            Size::Full => suite::Size::Full,
        },
        scenes: args.scenes.clone(),
        adapter: args.device.adapter(),
        quiet: args.quiet.is_quiet(),
    };
    let report = suite::run(&settings, |report| keep(report, args.json.as_deref()))?;
    stdout::print(&show::report(&report))?;
    match (report.interrupted, report.runs.len()) {
        (false, _) => Ok(()),
        (true, 0) => Err(Error::interrupted("nothing was finished")),
        (true, 1) => Err(Error::interrupted("one measurement was finished")),
        (true, finished) => Err(Error::interrupted(format!(
            "{finished} measurements were finished"
        ))),
    }
}

/// What was finished is on disk, whatever comes next.
fn keep(report: &Report, path: Option<&Path>) -> Result<()> {
    match path {
        Some(path) => write_file(path, &report.json()),
        None => Ok(()),
    }
}
