//! The command line: one file a command. Data goes to standard output, everything else to standard error.

#[cfg(not(all(feature = "study", feature = "surface")))]
mod absent;
#[cfg(feature = "study")]
mod bench;
mod checkpoint_args;
mod completions;
mod device_args;
mod devices;
mod diff;
mod gallery;
mod grid;
mod guard_args;
mod import;
mod inspect;
mod look_args;
mod measure;
mod neighbors;
mod new;
mod particle_args;
mod plan;
mod plan_error;
mod plan_measure;
mod quiet_args;
mod render;
mod rerun_args;
mod resume;
mod run;
mod run_args;
mod scene_args;
mod scenes;
mod schema;
mod sitting_args;
mod stdout;
#[cfg(feature = "study")]
mod study;
#[cfg(feature = "surface")]
mod surface;
mod table;
mod usd;

#[cfg(not(feature = "surface"))]
use absent::surface;
#[cfg(not(feature = "study"))]
use absent::{bench, study};
use clap::{CommandFactory as _, Parser, Subcommand};

use crate::error::Result;

/// Offline particle simulator and renderer: from a scene file to an animation, on any GPU or none
#[derive(Parser)]
#[command(version, after_help = EXAMPLES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXAMPLES: &str = "\
Examples:
  sliceflow scenes                              what ships
  sliceflow new my_dam                          a scene to begin with, my_dam.json
  sliceflow run green_cube                      frames into out/green_cube
  sliceflow run green_cube --set grains.spring=2e5 --out out/stiff
  sliceflow resume out/green_cube               goes on where it was stopped
  sliceflow plan green_cube                     what would run, and what it needs";

#[derive(Subcommand)]
enum Command {
    Run(run::Args),
    Resume(resume::Args),
    Render(render::Args),
    Diff(diff::Args),
    Plan(plan::Args),
    Inspect(inspect::Args),
    Measure(measure::Args),
    Neighbors(neighbors::Args),
    Gallery(gallery::Args),
    Surface(surface::Args),
    Usd(usd::Args),
    Import(import::Args),
    New(new::Args),
    Scenes(scenes::Args),
    Schema(schema::Args),
    Devices(devices::Args),
    Study(study::Args),
    Bench(bench::Args),
    Completions(completions::Args),
}

/// The command line, for what explains or completes it.
pub fn command() -> clap::Command {
    Cli::command()
}

/// Does what the program's arguments say. Ends the program after `--help`, and when they make no sense.
pub fn main() -> Result<()> {
    match Cli::parse().command {
        Command::Run(args) => run::main(&args),
        Command::Resume(args) => resume::main(&args),
        Command::Render(args) => render::main(&args),
        Command::Diff(args) => diff::main(&args),
        Command::Plan(args) => plan::main(&args),
        Command::Inspect(args) => inspect::main(&args),
        Command::Measure(args) => measure::main(&args),
        Command::Neighbors(args) => neighbors::main(&args),
        Command::Gallery(args) => gallery::main(&args),
        Command::Surface(args) => surface::main(&args),
        Command::Usd(args) => usd::main(&args),
        Command::Import(args) => import::main(&args),
        Command::New(args) => new::main(&args),
        Command::Scenes(args) => scenes::main(&args),
        Command::Schema(args) => schema::main(&args),
        Command::Devices(args) => devices::main(&args),
        Command::Study(args) => study::main(&args),
        Command::Bench(args) => bench::main(&args),
        Command::Completions(args) => completions::main(&args, Cli::command()),
    }
}

/// The arguments of `sliceflow run` in a command line that was recorded.
fn run_args(command_line: &[String]) -> Option<run::Args> {
    match Cli::try_parse_from(command_line).ok()?.command {
        Command::Run(args) => Some(args),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_are_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn every_command_has_examples() {
        for command in Cli::command().get_subcommands() {
            let help = command
                .get_after_help()
                .map(ToString::to_string)
                .unwrap_or_default();
            let example = format!("sliceflow {}", command.get_name());
            assert!(help.contains(&example), "{} has no example", command.get_name());
        }
    }
}
